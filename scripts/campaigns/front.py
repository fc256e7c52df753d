"""Flies every mission of a campaign that is not flown yet, as a Snakemake workflow.

    scripts/campaign FILE --out DIR [--jobs N] [--dry-run] [--retry-failed] [--world NAME=MESH]

A campaign that was stopped goes on where it was; a finished mission is never flown again. Exit
code: 0 all flown, 1 some mission crashed, hung or was refused, or the machine failed, 2 bad
description, 130 interrupted.
"""
import argparse
import fcntl
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys

from campaigns import checks, description, fly, progress

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent
SHARE = SCRIPTS.parent
SNAKEFILE = SCRIPTS / "campaigns" / "Snakefile"
INSTALL = SCRIPTS / "install"
LOOK_PERIOD_S = 0.5
GRACE_S = 15  # for jobs that are told to end


class Refused(Exception):
    """The campaign cannot be flown as asked; the text says what to do."""


def parsed(arguments):
    parser = argparse.ArgumentParser(prog="campaign", description=__doc__.split("\n\n")[0])
    parser.add_argument("file", type=pathlib.Path, help="description, see config/campaigns")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder for the results")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="missions at a time")
    parser.add_argument("--dry-run", action="store_true", help="check and list, fly nothing")
    parser.add_argument("--retry-failed", action="store_true",
                        help="fly again what crashed, hung or was refused")
    parser.add_argument("--world", action="append", default=[], metavar="NAME=MESH",
                        help="mesh of a world of the description")
    parser.add_argument("--mission", type=pathlib.Path, default=default_executable(),
                        help="the mission executable")
    options = parser.parse_args(arguments)
    if options.jobs < 1:
        parser.error("--jobs must be at least 1")
    return options


def default_executable():
    build = os.environ.get("SPELUNK_BUILD_DIR", SHARE / "build")
    return pathlib.Path(build) / "devel" / "lib" / "spelunk" / "mission"


def meshes_of(pairs):
    meshes = {}
    for pair in pairs:
        name, separator, path = pair.partition("=")
        if not separator or not name or not path:
            raise Refused(f"--world {pair}: write it as NAME=MESH, e.g. edgar=/path/to/mine.stl")
        meshes[name] = str(pathlib.Path(path).resolve())
    return meshes


def checked_campaign(options):
    """The campaign, if nothing keeps it from being flown."""
    campaign = description.read(options.file, meshes_of(options.world))
    if not os.access(options.mission, os.X_OK):
        raise Refused(f"{options.mission} is no executable: run scripts/build, or give --mission "
                      "PATH")
    problems = checks.all_problems(campaign, SHARE, options.mission,
                                   {**os.environ, "SPELUNK_SHARE": str(SHARE)},
                                   options.out)
    if problems:
        raise description.DescriptionError(options.file, problems)
    return campaign


def opened(out):
    """Creates the folder and returns its lock, which ends with this process."""
    try:
        (out / "missions").mkdir(parents=True, exist_ok=True)
        fly.require_space(out)
        lock = open(out / ".lock", "w", encoding="utf-8")
    except fly.MachineError as error:
        raise Refused(str(error)) from error
    except OSError as error:
        raise Refused(f"--out {out}: {error.strerror}; choose a folder that can be "
                      "written") from error
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        raise Refused(f"--out {out}: another campaign is flying into it") from error
    return lock


def remove_unfinished(out):
    """Half-flown folders of a campaign that was killed."""
    for folder in [*out.glob("missions/.*.part.*"), *out.glob("best_possible/.*.part.*")]:
        shutil.rmtree(folder, ignore_errors=True)


def remove_failed(campaign, out):
    for jobs, place in ((campaign.missions, out / "missions"),
                        (campaign.best_possible, out / "best_possible")):
        for name, outcome in progress.outcomes_of(jobs, place).items():
            if outcome["kind"] in fly.FAILED_KINDS:
                shutil.rmtree(place / name)


def install_solver(campaign, out):
    """OR-tools, where the campaign has tours to lay out. Raises Refused."""
    missing = [asked for asked in campaign.best_possible
               if not (out / "best_possible" / asked.name).exists()]
    if missing and subprocess.run([INSTALL, "tour"], stdin=subprocess.DEVNULL,
                                  check=False).returncode != 0:
        raise Refused("OR-tools cannot be installed, which tours of best_possible need: see above, "
                      "or leave best_possible out of the description")


def snakemake(campaign, options):
    """The command that flies all that is missing."""
    return ["setpriv", "--pdeathsig", "KILL", "snakemake", "--snakefile", str(SNAKEFILE),
            "--directory", str(options.out), "--cores", str(options.jobs), "--scheduler", "greedy",
            "--rerun-triggers", "mtime", "--ignore-incomplete", "--keep-incomplete", "--nolock",
            "--config", f"description={options.file.resolve()}",
            f"mission={options.mission.absolute()}", f"meshes={json.dumps(campaign.meshes)}"]


def end(process):
    """Ends the workflow and all its jobs."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        try:
            os.killpg(process.pid, number)
            process.wait(timeout=GRACE_S)
        except ProcessLookupError:
            break
        except subprocess.TimeoutExpired:
            continue


def watched(command, display, log):
    """Runs the workflow to its end; its exit code, or None if somebody interrupted it."""
    def stop(_number, _frame):
        raise KeyboardInterrupt
    signal.signal(signal.SIGTERM, stop)
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log,
                               stderr=subprocess.STDOUT, start_new_session=True)
    try:
        while True:
            try:
                return process.wait(timeout=LOOK_PERIOD_S)
            except subprocess.TimeoutExpired:
                display.show()
    except KeyboardInterrupt:
        end(process)
        return None
    finally:
        display.show()


def what_failed(log):
    """What our own jobs said, else the end of the log."""
    lines = log.read_text(errors="replace").splitlines()
    ours = [line for line in lines if line.startswith("campaign: ")]
    return "\n".join(dict.fromkeys(ours)) or "\n".join(lines[-20:])


def concluded(campaign, options, code):
    """Says how it went; the exit code of this program."""
    outcomes = progress.outcomes_of(campaign.missions, options.out / "missions")
    best = progress.outcomes_of(campaign.best_possible, options.out / "best_possible")
    if sys.stdout.isatty():
        print()
    print(f"campaign: {len(outcomes)} of {len(campaign.missions)} missions flown: "
          f"{progress.kinds_text(outcomes)}")
    if campaign.best_possible:
        print(f"campaign: {len(best)} of {len(campaign.best_possible)} best possibles known: "
              f"{progress.kinds_text(best)}")
    if code is None:
        print("campaign: interrupted; the same command goes on from here", file=sys.stderr)
        return 130
    if code != 0:
        log = options.out / "snakemake.log"
        print(f"{what_failed(log)}\ncampaign: stopped early; the whole log is {log}",
              file=sys.stderr)
        return 1
    print(f"campaign: {options.out / 'campaign.csv'}; next: scripts/report {options.out}")
    return int(any(outcome["kind"] in fly.FAILED_KINDS
                   for outcome in [*outcomes.values(), *best.values()]))


def list_missions(campaign, options):
    """What would be flown."""
    outcomes = progress.outcomes_of(campaign.missions, options.out / "missions")
    for mission in campaign.missions:
        print(f"{outcomes.get(mission.name, {}).get('kind', 'to fly')}: {mission.name}")
    best = progress.outcomes_of(campaign.best_possible, options.out / "best_possible")
    for asked in campaign.best_possible:
        print(f"{best.get(asked.name, {}).get('kind', 'to find out')}: best_possible {asked.name}")
    count = len(campaign.missions)
    print(f"campaign: {count - len(outcomes)} of {count} missions to fly")
    return 0


def flown(options):
    """The whole campaign; the exit code."""
    campaign = checked_campaign(options)
    if options.dry_run:
        return list_missions(campaign, options)
    with opened(options.out):
        remove_unfinished(options.out)
        if options.retry_failed:
            remove_failed(campaign, options.out)
        install_solver(campaign, options.out)
        display = progress.Display(campaign, options.out, options.jobs)
        with open(options.out / "snakemake.log", "wb") as log:
            code = watched(snakemake(campaign, options), display, log)
        return concluded(campaign, options, code)


def main():
    try:
        return flown(parsed(sys.argv[1:]))
    except (Refused, description.DescriptionError) as error:
        print(f"campaign: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
