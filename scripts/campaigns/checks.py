"""What a description names, compared with what is there: worlds, robots, planners, parameters."""
import json
import pathlib
import subprocess

from campaigns import table

MESH_SUFFIXES = (".dae", ".stl", ".obj", ".ply")
CHECK_LIMIT_S = 60  # for printing a list of parameters


def names_in(folder):
    return sorted(path.stem for path in folder.glob("*.yaml"))


def world_problems(campaign, share):
    """Worlds that are neither in worlds/ nor a mesh, and meshes nobody flies in."""
    problems = []
    used = {mission.world for mission in campaign.missions}
    known = names_in(share / "worlds")
    for world in sorted(used - set(known) - set(campaign.meshes)):
        problems.append(f"world \"{world}\" is not in {share / 'worlds'}; give its mesh with "
                        f"--world {world}=PATH or choose one of: {', '.join(known)}")
    for name, text in sorted(campaign.meshes.items()):
        path = pathlib.Path(text)
        if name not in used:
            problems.append(f"--world {name}: no mission flies there; worlds: "
                            f"{', '.join(sorted(used))}")
        elif path.suffix.lower() not in MESH_SUFFIXES or not path.is_file():
            problems.append(f"world \"{name}\": {path} is no mesh ({' '.join(MESH_SUFFIXES)})")
    return problems


def robot_problems(campaign, share):
    known = names_in(share / "config" / "robots")
    named = {mission.robot for mission in campaign.missions if not mission.robot_file}
    files = {(kind, path) for mission in campaign.missions for kind, path in
             (("robot", mission.robot_file), ("planner", mission.planner_file)) if path}
    return [f"robot \"{robot}\" is not known; give the path of a file or one of: "
            f"{', '.join(known)}" for robot in sorted(named - set(known))] + \
           [f"{kind} file {path} is not there" for kind, path in sorted(files)
            if not pathlib.Path(path).is_file()]


def executable_problems(campaign, executable, environment, robots, folder):
    """What the mission executable refuses: unknown planners, wrong parameters, unfit robots.

    It is asked in `folder`, where it will fly, if that is there.
    """
    problems = []
    sets = {(mission.robot_file or mission.robot, mission.planner_file or mission.planner,
             mission.parameter_set, mission.settings)
            for mission in campaign.missions if mission.robot_file or mission.robot in robots}
    for robot, planner, name, settings in sorted(sets):
        command = [str(executable.resolve()), "--robot", robot, "--planner", planner, "--list-params"]
        for key, value in settings:
            command += ["--set", f"{key}={value}"]
        try:
            answer = subprocess.run(command, env=environment, capture_output=True, text=True,
                                    cwd=folder if folder.is_dir() else None, check=False,
                                    timeout=CHECK_LIMIT_S)
        except (OSError, subprocess.TimeoutExpired) as error:
            return problems + [f"{executable} cannot be asked: {error}"]
        if answer.returncode != 0:
            said = answer.stderr.strip() or f"exit code {answer.returncode}"
            problems.append(f"{planner} on {robot} with parameter set \"{name}\": {said}")
    return sorted(set(problems))


def differing(campaign, missions_folder):
    """Missions flown before under the same name with other settings."""
    described = {mission.name: dict(mission.settings) for mission in campaign.missions}
    problems = []
    for folder in table.complete_folders(missions_folder):
        flown = json.loads((folder / "outcome.json").read_text())["settings"]
        if flown != described.get(folder.name, flown):
            problems.append(f"{folder} was flown with other settings ({flown}); choose another "
                            "--out or another name for the parameter set")
    return problems


def all_problems(campaign, share, executable, environment, out):
    """Everything that would keep the campaign from being flown as described."""
    robots = set(names_in(share / "config" / "robots"))
    return (world_problems(campaign, share) + robot_problems(campaign, share)
            + executable_problems(campaign, executable, environment, robots, out)
            + differing(campaign, out / "missions"))
