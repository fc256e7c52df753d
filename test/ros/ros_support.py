"""What the tests of the nodes share: waiting for messages, and a made-up robot in a room."""

import threading
import time

import numpy as np
import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud2, PointField
from spelunk.msg import PlannerStatus
from std_srvs.srv import Trigger


class Listener:
    """Keeps the messages of a topic and waits for one that meets a condition."""

    def __init__(self, topic, message_type):
        self._condition = threading.Condition()
        self.messages = []
        self._subscriber = rospy.Subscriber(topic, message_type, self._take, queue_size=100)

    def _take(self, message):
        with self._condition:
            self.messages.append(message)
            self._condition.notify_all()

    def count(self):
        with self._condition:
            return len(self.messages)

    def latest(self):
        with self._condition:
            return self.messages[-1] if self.messages else None

    def wait(self, accepts, timeout_s, since=0):
        """The first message from number `since` on that `accepts`; None after `timeout_s` of wall
        time."""
        deadline = time.monotonic() + timeout_s
        with self._condition:
            seen = since
            while True:
                for message in self.messages[seen:]:
                    if accepts(message):
                        return message
                seen = len(self.messages)
                left = deadline - time.monotonic()
                if left <= 0.0 or rospy.is_shutdown():
                    return None
                self._condition.wait(left)


class MissionChecks:
    """For test cases that let both nodes run a whole mission; call fly_mission() in setUpClass, after
    the case's own listeners are there."""

    @classmethod
    def fly_mission(cls, settle_s, done_within_s):
        cls.status = Listener("status", PlannerStatus)
        cls.odometry = Listener("odometry", Odometry)
        assert cls.odometry.wait(lambda _: True, 20.0), "no odometry"
        rospy.wait_for_service("planner_node/start", timeout=20.0)
        rospy.sleep(settle_s)
        cls.start = rospy.ServiceProxy("planner_node/start", Trigger)()
        cls.done = cls.status.wait(lambda status: status.state == "Done", done_within_s)

    def test_explores_and_ends_with_a_reason(self):
        self.assertTrue(self.start.success, self.start.message)
        self.assertIsNotNone(self.done, "not done in time; last: %s" % self.status.latest())
        self.assertRegex(self.done.reason, "explored|home by endurance")
        self.assertGreater(self.done.distance_m, 2.0, "the robot hardly moved")
        self.assertGreater(self.done.explored_volume_m3, 100.0)
        self.assertGreater(self.done.remaining_s, 0.0)
        self.assertGreater(self.done.plans, 0)


def cloud_message(points, frame, stamp):
    """float32 x, y, z from an array of shape (n, 3), metres in `frame`."""
    message = PointCloud2()
    message.header.frame_id = frame
    message.header.stamp = stamp
    message.height = 1
    message.width = len(points)
    for axis, name in enumerate("xyz"):
        message.fields.append(PointField(name, 4 * axis, PointField.FLOAT32, 1))
    message.point_step = 12
    message.row_step = 12 * len(points)
    message.is_dense = False
    message.data = np.asarray(points, dtype=np.float32).tobytes()
    return message


def room_hits(origin, half_size, columns=360, rows=16):
    """Where the rays of a LiDAR at `origin` hit the walls of a box room around (0, 0, 0). Nothing
    comes back from the quarter ahead, so there is always something left to explore."""
    azimuth, elevation = np.meshgrid(np.linspace(0.25 * np.pi, 1.75 * np.pi, columns),
                                     np.radians(np.linspace(-45.0, 45.0, rows)))
    directions = np.stack([np.cos(elevation) * np.cos(azimuth),
                           np.cos(elevation) * np.sin(azimuth), np.sin(elevation)], axis=-1)
    directions = directions.reshape(-1, 3)
    with np.errstate(divide="ignore"):
        ranges = np.where(directions > 0.0, half_size - origin, -half_size - origin) / directions
    return directions * np.nanmin(np.where(ranges > 0.0, ranges, np.inf), axis=1)[:, None]


class MadeUpRobot:
    """A robot that hangs in a box room, as its driver would publish it. Each publish_... sends one
    message at the current ROS time; tests change what is sent."""

    HALF_SIZE = np.array([8.0, 6.0, 3.0])

    def __init__(self):
        self.position = np.zeros(3)
        self._odometry = rospy.Publisher("odometry", Odometry, queue_size=10)
        self._cloud = rospy.Publisher("pointcloud", PointCloud2, queue_size=10)
        self._tf = tf2_ros.TransformBroadcaster()

    def odometry(self):
        message = Odometry()
        message.header.stamp = rospy.Time.now()
        message.header.frame_id = "world"
        message.child_frame_id = "base_link"
        message.pose.pose.position.x, message.pose.pose.position.y, \
            message.pose.pose.position.z = self.position
        message.pose.pose.orientation.w = 1.0
        return message

    def cloud(self):
        return cloud_message(room_hits(self.position, self.HALF_SIZE), "lidar_16",
                             rospy.Time.now())

    def publish_tf(self):
        self.send_frames("base_link", "lidar_16")

    def send_frames(self, base, sensor):
        """The transforms world -> base -> sensor of now."""
        transforms = []
        for parent, child, offset in (("world", base, self.position),
                                      (base, sensor, np.zeros(3))):
            transform = TransformStamped()
            transform.header.stamp = rospy.Time.now()
            transform.header.frame_id = parent
            transform.child_frame_id = child
            transform.transform.translation.x, transform.transform.translation.y, \
                transform.transform.translation.z = offset
            transform.transform.rotation.w = 1.0
            transforms.append(transform)
        self._tf.sendTransform(transforms)

    def publish_odometry(self, message):
        self._odometry.publish(message)

    def publish_cloud(self, message):
        self._cloud.publish(message)

    def publish(self, odometry=None, cloud=None):
        self.publish_tf()
        self.publish_odometry(odometry or self.odometry())
        self.publish_cloud(cloud or self.cloud())
