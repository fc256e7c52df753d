"""Flies one mission of a campaign and records how it ended, whatever happens.

    python3 -m campaigns.fly --executable PATH --out missions/NAME ORDER

ORDER is JSON (see `order_of`). The folder appears under its name when it is complete, never before:
it holds what the mission wrote, mission.log and outcome.json. A mission that crashes or hangs is a
result, too; only trouble of the machine (no space, no rights, a signal) makes this program fail.
"""
import argparse
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import time

FINISHED, STRANDED, CRASH, HANG, BAD_INPUT = "finished", "stranded", "crash", "hang", "bad input"
FAILED_KINDS = (CRASH, HANG, BAD_INPUT)
REQUIRED_FILES = ("summary.json", "timeline.csv")
PROBE_BYTES = 1 << 20  # more than any of our own files takes


class MachineError(Exception):
    """The machine, not the mission, is at fault; nothing is recorded."""


class Interrupted(Exception):
    """Somebody wants this program to end."""


def order_of(mission, meshes):
    """What `fly` must know of a mission."""
    return {"mission": mission.name, "world": mission.world, "robot": mission.robot,
            "planner": mission.planner, "parameter_set": mission.parameter_set,
            "settings": dict(mission.settings), "time_limit_s": mission.time_limit_s,
            "seed": mission.seed, "wall_limit_s": mission.wall_limit_s,
            "arguments": mission.arguments(meshes)}


def part_folder(out):
    """Where a mission is flown; a name of its own: another machine may fly beside this one."""
    return out.with_name(f".{out.name}.part.{socket.gethostname()}.{os.getpid()}")


def require_space(folder):
    """Raises MachineError if `folder` does not take another file."""
    probe = folder / ".space_test"
    try:
        with open(probe, "wb") as file:
            file.write(bytes(PROBE_BYTES))
            file.flush()
            os.fsync(file.fileno())
        probe.unlink()
    except OSError as error:
        raise MachineError(f"{folder}: cannot be written: {error.strerror}; free some space or "
                           "choose another --out") from error


def run(command, log, wall_limit_s):
    """Exit code of the command (negative: the signal), or None if it took too long."""
    # The mission dies with this program, even if that is killed hard.
    process = subprocess.Popen(["setpriv", "--pdeathsig", "KILL", *command],
                               stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT,
                               start_new_session=True)
    try:
        return process.wait(timeout=wall_limit_s)
    except subprocess.TimeoutExpired:
        return None
    finally:
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        process.wait()


def last_line(path):
    lines = path.read_text(errors="replace").strip().splitlines()
    return lines[-1].strip() if lines else "it said nothing"


def judge(code, folder, wall_limit_s):
    """Kind of outcome and the reason."""
    log = folder / "mission.log"
    if code is None:
        return HANG, f"not done after {wall_limit_s:g} s of wall time"
    if code < 0:
        return CRASH, f"killed by {signal.Signals(-code).name}"
    if code == 2:
        return BAD_INPUT, last_line(log)
    missing = [name for name in REQUIRED_FILES if not (folder / name).is_file()]
    if code not in (0, 1) or missing:
        wrote = f" without {' and '.join(missing)}" if missing else ""
        return CRASH, f"exit code {code}{wrote}: {last_line(log)}"
    outcome = json.loads((folder / "summary.json").read_text())["outcome"]
    return (FINISHED if code == 0 else STRANDED), outcome


def fly(executable, order, folder):
    """Flies into `folder` and writes its outcome.json."""
    begin = time.monotonic()
    with open(folder / "mission.log", "wb") as log:
        code = run([executable, *order["arguments"], "--out", str(folder)], log,
                   order["wall_limit_s"])
    require_space(folder)  # otherwise a full disk would pass for a fault of the mission
    kind, reason = judge(code, folder, order["wall_limit_s"])
    record = {**order, "kind": kind, "reason": reason, "exit_code": code,
              "wall_time_s": round(time.monotonic() - begin, 3)}
    (folder / "outcome.json").write_text(json.dumps(record, indent=2) + "\n")


def settle(folder):
    """Brings the files to the disk: a power cut must not leave a complete folder of empty files."""
    for path in folder.iterdir():
        with open(path, "rb") as file:
            os.fsync(file.fileno())


def interrupt(number, _frame):
    raise Interrupted(signal.Signals(number).name)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--executable", required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("order", type=json.loads)
    options = parser.parse_args()
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        signal.signal(number, interrupt)
    folder = part_folder(options.out)
    try:
        folder.mkdir(parents=True)
        require_space(folder)
        fly(options.executable, options.order, folder)
        settle(folder)
        folder.rename(options.out)
    except (MachineError, OSError, Interrupted) as error:
        print(f"campaign: {options.out.name}: {error}", file=sys.stderr)
        return 1
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
