"""Reads the description of a campaign: which missions there are.

    title: Small room, two planners
    parameter_sets:                  # `default` is always there and changes nothing
      fine: {map.resolution_m: 0.1}
      guided: {oracle.tour: "tours/{world}__{robot}__{time_limit_s}.csv"}  # seen from --out
    groups:                          # every combination within a group is one mission
      - worlds: [room]
        robots: [aerial]                  # names or paths of files, seen from this file's folder
        planners: [gbplanner, informed]   # the same
        parameter_sets: [default, fine]   # optional, default
        seeds: 1-15                       # or a list
        time_limits_s: [900]
        wall_limit_s: 1860                # optional, 60 s and twice the time limit
        best_possible: true               # optional: also find out what can be explored at best
    meshes: {edgar: /path/to/mine.stl}    # optional: worlds that are files, seen from here, too
    references: [...]                     # optional: figures of a paper, for the report
"""
import dataclasses
import itertools
import pathlib
import re

import yaml

TOP_KEYS = {"title", "parameter_sets", "groups", "meshes", "references"}
GROUP_KEYS = {"worlds", "robots", "planners", "parameter_sets", "seeds", "time_limits_s", "wall_limit_s",
              "best_possible"}
WHAT_IS_POSSIBLE = ("robot.", "sensor.")  # settings of these; others change how it is explored
REFERENCE_KEYS = {"world", "robot", "time_limit_s", "label", "vertices", "edges", "navigation_s",
                  "exploration_s", "volume_m3"}
NAME = re.compile(r"[A-Za-z0-9]+([._-][A-Za-z0-9]+|_)*")
SET_KEY = re.compile(r"[a-z][a-z0-9_]*(\.[a-z][a-z0-9_]*)+")
PLACEHOLDER = re.compile(r"{([^{}]*)}")
PLACEHOLDERS = ("world", "robot", "time_limit_s")
SEED_RANGE = re.compile(r"(\d+)-(\d+)")


class DescriptionError(Exception):
    """All that is wrong with a campaign, one line a problem."""

    def __init__(self, source, problems):
        lines = "".join(f"\n  - {problem}" for problem in problems)
        super().__init__(f"{source}: {len(problems)} problem(s):{lines}")
        self.problems = problems


@dataclasses.dataclass(frozen=True)
class Mission:
    """One flight; `settings` are pairs of a parameter and its value as text."""

    world: str
    robot: str
    planner: str
    parameter_set: str
    time_limit_s: float
    seed: int
    settings: tuple
    wall_limit_s: float
    robot_file: str = ""  # where the robot, the planner is a file and not one of the package's
    planner_file: str = ""

    @property
    def name(self):
        """Its folder; what sorts the missions of a planner together."""
        return "__".join([self.world, self.robot, self.planner, self.parameter_set,
                          number_text(self.time_limit_s), f"{self.seed:03d}"])

    def arguments(self, meshes):
        """What the mission executable is told, all but the output folder."""
        pairs = [("--world", str(meshes.get(self.world, self.world))),
                 ("--robot", self.robot_file or self.robot),
                 ("--planner", self.planner_file or self.planner), ("--seed", str(self.seed)),
                 ("--time-limit-s", number_text(self.time_limit_s))]
        pairs += [("--set", f"{key}={value}") for key, value in self.settings]
        return [text for pair in pairs for text in pair]


@dataclasses.dataclass(frozen=True)
class BestPossible:
    """What can be explored at best: asked once for all planners."""

    world: str
    robot: str
    time_limit_s: float
    settings: tuple
    robot_file: str = ""

    @property
    def name(self):
        return "__".join([self.world, self.robot, number_text(self.time_limit_s)])

    def arguments(self, meshes):
        """What scripts/best_possible is told, all but the output folder."""
        pairs = [("--world", str(meshes.get(self.world, self.world))),
                 ("--robot", self.robot_file or self.robot),
                 ("--time-limit-s", number_text(self.time_limit_s))]
        pairs += [("--set", f"{key}={value}") for key, value in self.settings]
        return [text for pair in pairs for text in pair]


@dataclasses.dataclass(frozen=True)
class Campaign:
    """Missions and best possibles in the order of their names; meshes of worlds that are files."""

    title: str
    missions: tuple
    best_possible: tuple
    meshes: dict
    references: tuple


def number_text(value):
    """The shortest text of a number: 900, not 900.0."""
    return str(int(value)) if float(value).is_integer() else repr(float(value))


def value_text(value):
    """A value as `--set key=value` takes it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return number_text(value)
    if isinstance(value, list):
        return "[" + ",".join(value_text(item) for item in value) + "]"
    return str(value)


def filled(settings, values):
    """The settings with every {world}, {robot} and {time_limit_s} replaced."""
    return tuple((key, PLACEHOLDER.sub(lambda match: values.get(match[1], match[0]), text))
                 for key, text in settings)


class Reader:
    """Collects problems instead of stopping at the first."""

    def __init__(self, folder):
        self.folder = folder  # relative paths are seen from here
        self.files = {}  # of a group: kind and name of a robot or planner that is a file -> its path
        self.problems = []
        self.asked = []  # missions whose group asks for the best possible

    def is_map(self, value, where, known):
        """Whether `value` is a map; names the keys nobody reads."""
        if not isinstance(value, dict):
            self.problems.append(f"{where}: must be a map of {', '.join(sorted(known))}")
            return False
        for key in value:
            if key not in known:
                self.problems.append(f"{where}: unknown key \"{key}\"; known: "
                                     f"{', '.join(sorted(known))}")
        return True

    def names(self, value, where):
        """A list of names that can be part of a folder's name; empty if it is none."""
        if not isinstance(value, list) or not value:
            self.problems.append(f"{where}: must be a list of names, such as [gbplanner]")
            return []
        for item in value:
            if not NAME.fullmatch(str(item)) or "__" in str(item):
                self.problems.append(f"{where}: \"{item}\" is no name (letters, digits, single "
                                     "_ . -)")
        return [str(item) for item in value]

    def path(self, text):
        return (self.folder / pathlib.Path(text).expanduser()).resolve()

    def names_or_files(self, value, where):
        """The same; paths of YAML files become their names and are kept in `files`."""
        if not isinstance(value, list):
            return self.names(value, where)
        found = []
        for item in map(str, value):
            if "/" not in item and not item.endswith((".yaml", ".yml")):
                found.append(item)
                continue
            path = self.path(item)
            found.append(path.stem)
            if self.files.setdefault((where.rpartition(".")[2], path.stem), str(path)) != str(path):
                self.problems.append(f"{where}: two files are called \"{path.stem}\"")
        return self.names(found, where)

    def is_positive(self, value, where):
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 < value < 1e7:
            self.problems.append(f"{where}: \"{value}\" is no positive number of seconds")
            return False
        return True

    def times(self, value, where):
        if not isinstance(value, list) or not value:
            self.problems.append(f"{where}: must be a list of seconds, such as [900]")
            return []
        return [item for item in value if self.is_positive(item, where)]

    def seeds(self, value, where):
        """From `1-15` or a list of numbers."""
        span = SEED_RANGE.fullmatch(value) if isinstance(value, str) else None
        if span and int(span[1]) <= int(span[2]):
            return list(range(int(span[1]), int(span[2]) + 1))
        if isinstance(value, list) and value and all(type(item) is int and item >= 0
                                                     for item in value):
            return value
        self.problems.append(f"{where}: must be first-last, such as 1-15, or a list of whole "
                             "numbers")
        return []

    def parameter_sets(self, value):
        """Name of each set -> its settings, in the order of their names."""
        sets = {"default": ()}
        if value is None:
            return sets
        if not isinstance(value, dict):
            self.problems.append("parameter_sets: must be a map from name to settings")
            return sets
        for name, settings in value.items():
            self.names([name], "parameter_sets")
            if not isinstance(settings, dict):
                self.problems.append(f"parameter_sets.{name}: must be a map such as "
                                     "{map.resolution_m: 0.1}")
                continue
            sets[name] = self.settings(settings, f"parameter_sets.{name}")
        return sets

    def settings(self, settings, where):
        """Pairs of a parameter and its value as text, in the order of their names."""
        found = tuple(sorted((str(key), value_text(item)) for key, item in settings.items()))
        for key, text in found:
            if not SET_KEY.fullmatch(key):
                self.problems.append(f"{where}: \"{key}\" is no parameter's name; write "
                                     "section.name")
            for unknown in sorted(set(PLACEHOLDER.findall(text)) - set(PLACEHOLDERS)):
                self.problems.append(f"{where}.{key}: {{{unknown}}} stands for nothing; known: "
                                     f"{', '.join(PLACEHOLDERS)}")
        return found

    def group(self, group, where, sets):
        """Every mission of one group."""
        if not self.is_map(group, where, GROUP_KEYS):
            return []
        self.files = {}
        worlds = self.names(group.get("worlds"), f"{where}.worlds")
        robots = self.names_or_files(group.get("robots"), f"{where}.robots")
        planners = self.names_or_files(group.get("planners"), f"{where}.planners")
        chosen = self.names(group.get("parameter_sets", ["default"]), f"{where}.parameter_sets")
        seeds = self.seeds(group.get("seeds"), f"{where}.seeds")
        times = self.times(group.get("time_limits_s"), f"{where}.time_limits_s")
        wall = group.get("wall_limit_s")
        if wall is not None and not self.is_positive(wall, f"{where}.wall_limit_s"):
            wall = None
        for name in chosen:
            if name not in sets:
                self.problems.append(f"{where}: parameter set \"{name}\" is not described; known: "
                                     f"{', '.join(sorted(sets))}")
        missions = [
            Mission(world, robot, planner, name, float(time), seed,
                    filled(sets.get(name, ()), {"world": world, "robot": robot,
                                                "time_limit_s": number_text(time)}),
                    float(wall or 60 + 2 * time), self.files.get(("robots", robot), ""),
                    self.files.get(("planners", planner), ""))
            for world, robot, planner, name, time, seed
            in itertools.product(worlds, robots, planners, chosen, times, seeds)]
        if self.is_asked(group.get("best_possible", False), f"{where}.best_possible"):
            self.asked += missions
        return missions

    def is_asked(self, value, where):
        if not isinstance(value, bool):
            self.problems.append(f"{where}: \"{value}\" is neither true nor false")
        return value is True

    def references(self, value):
        if value is not None and not isinstance(value, list):
            self.problems.append("references: must be a list")
        for number, item in enumerate(value if isinstance(value, list) else [], 1):
            where = f"references[{number}]"
            if self.is_map(item, where, REFERENCE_KEYS) and set(item) < REFERENCE_KEYS:
                missing = ", ".join(sorted(REFERENCE_KEYS - set(item)))
                self.problems.append(f"{where}: lacks {missing}")
        return tuple(value) if isinstance(value, list) else ()


def distinct(missions, problems):
    """Sorted by name; a mission that is described twice is a problem."""
    by_name = {}
    for mission in missions:
        if mission.name in by_name:
            problems.append(f"mission {mission.name} is described twice")
        by_name[mission.name] = mission
    return tuple(by_name[name] for name in sorted(by_name))


def best_possible_of(missions, problems):
    """One for all missions of a robot in a world with a time limit, sorted by name."""
    by_name = {}
    for mission in missions:
        settings = tuple(pair for pair in mission.settings if pair[0].startswith(WHAT_IS_POSSIBLE))
        asked = BestPossible(mission.world, mission.robot, mission.time_limit_s, settings,
                             mission.robot_file)
        if by_name.setdefault(asked.name, asked) != asked:
            problems.append(f"best_possible {asked.name}: parameter sets differ in robot.* or "
                            "sensor.*, so there is no one best possible; describe two campaigns")
    return tuple(by_name[name] for name in sorted(by_name))


def parse(content, meshes=None, folder=pathlib.Path()):
    """The campaign that parsed YAML describes, and all that is wrong with it. Relative paths of
    robots and planners are seen from `folder`."""
    reader = Reader(folder)
    if not reader.is_map(content, "campaign", TOP_KEYS):
        return None, reader.problems
    sets = reader.parameter_sets(content.get("parameter_sets"))
    groups = content.get("groups")
    if not isinstance(groups, list) or not groups:
        reader.problems.append("groups: must be a list with at least one group")
        groups = []
    missions = [mission for number, group in enumerate(groups, 1)
                for mission in reader.group(group, f"groups[{number}]", sets)]
    described = content.get("meshes") or {}
    if not isinstance(described, dict):
        reader.problems.append("meshes: must be a map from name to the path of a mesh")
        described = {}
    described = {name: str(reader.path(str(path))) for name, path in described.items()}
    return Campaign(str(content.get("title", "Campaign")), distinct(missions, reader.problems),
                    best_possible_of(reader.asked, reader.problems),
                    {**described, **(meshes or {})},
                    reader.references(content.get("references"))), reader.problems


def read(path, meshes=None):
    """The campaign of a file; `meshes` win over its own. Raises DescriptionError."""
    try:
        with open(path, encoding="utf-8") as file:
            content = yaml.safe_load(file)
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise DescriptionError(path, [f"cannot be read: {error}"]) from error
    campaign, problems = parse(content, meshes, pathlib.Path(path).resolve().parent)
    if problems:
        raise DescriptionError(path, problems)
    return campaign
