#!/usr/bin/python3
"""Runs robot_state_publisher as soon as `robot_description` is there. Where it is not installed,
says what that costs and ends: nothing else depends on it."""

import os
import sys
import time

import rosgraph
import roslib.packages
import rospkg

PROGRAM = "robot_state_publisher"
POLL_S = 0.1


def find_program():
    try:
        found = roslib.packages.find_node(PROGRAM, PROGRAM)
    except rospkg.ResourceNotFound:
        return None
    return found[0] if found else None


def main():
    program = find_program()
    if program is None:
        print("robot_state_publisher is not installed (Debian: ros-robot-state-publisher): the legs "
              "are missing on tf and in RViz; all else works", file=sys.stderr)
        return 0
    master = rosgraph.Master("/" + PROGRAM)
    parameter = rosgraph.names.ns_join(rosgraph.names.get_ros_namespace(), "robot_description")
    try:
        while not master.hasParam(parameter):
            time.sleep(POLL_S)
    except KeyboardInterrupt:
        return 0
    os.execv(program, [program] + sys.argv[1:])


if __name__ == "__main__":
    sys.exit(main())
