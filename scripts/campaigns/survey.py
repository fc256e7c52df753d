"""A world's survey as `best_possible` wrote it: outlooks, the ways between them, what each sees."""
import collections
import copy
import json

import numpy as np
import scipy.sparse
import scipy.sparse.csgraph

LITRES_PER_M3 = 1000


class SurveyError(Exception):
    """The survey cannot be used; the text says why and what to do."""


def opened(folder):
    """The two files of a survey: the content of one, the bytes of the other."""
    try:
        data = json.loads((folder / "survey.json").read_text())
        return data, np.fromfile(folder / "survey_seen.bin", dtype=np.uint8)
    except (OSError, ValueError) as error:
        raise SurveyError(f"{folder}: no survey to be read ({error}); the executable "
                          "best_possible writes survey.json and survey_seen.bin") from error


def bits_of(rows, outlooks, voxels):
    """Row of each outlook: 1 for every voxel it sees."""
    if not outlooks or not voxels:
        raise SurveyError("the survey is empty: from the start the robot reaches nothing that it "
                          "could see anything from")
    if rows.size != outlooks * ((voxels + 7) // 8):
        raise SurveyError(f"survey_seen.bin holds {rows.size} bytes, which do not fit {outlooks} "
                          f"outlooks and {voxels} voxels; run best_possible again")
    return np.unpackbits(rows.reshape(outlooks, -1), axis=1, bitorder="little", count=voxels)


class Survey:
    """Outlook 0 is the start. Volumes are whole litres, so that no sum depends on its order."""

    def __init__(self, folder):
        data, rows = opened(folder)
        try:
            self.outlooks = np.array(data["outlooks"], dtype=float).reshape(-1, 3)
            self.litres = np.round(LITRES_PER_M3 * np.array(data["volumes_m3"], dtype=float))
            self.speed_mps = float(data["speed_mps"])
            self.ways = {(way["from"], way["to"]): way for way in data["ways"]}
        except (KeyError, TypeError, ValueError) as error:
            raise SurveyError(f"{folder / 'survey.json'}: no survey: {error!r}") from error
        bits = bits_of(rows, len(self.outlooks), len(self.litres))
        self.seen = [np.flatnonzero(row) for row in bits]
        self.seers = scipy.sparse.csr_matrix(bits.T)  # a row a voxel
        self.metres, self.before = self.shortest_ways()

    def shortest_ways(self):
        """Between any two outlooks; infinite where none leads."""
        ends = np.array(list(self.ways), dtype=int).reshape(-1, 2)
        lengths = np.maximum([way["length_m"] for way in self.ways.values()], 1e-6)
        graph = scipy.sparse.csr_matrix((lengths, (ends[:, 0], ends[:, 1])),
                                        shape=2 * [len(self.outlooks)])
        return scipy.sparse.csgraph.dijkstra(graph, directed=False, return_predecessors=True)

    def leg(self, start, end):
        """Outlooks on the shortest way from one to another, without the first."""
        found = [] if end == start else [end]
        while found and self.before[start, found[-1]] != start:
            found.append(int(self.before[start, found[-1]]))
        return found[::-1]

    def passed(self, stops):
        """The outlooks that a tour leads past, in order, its own included."""
        return [stops[0]] + [outlook for start, end in zip(stops, stops[1:])
                             for outlook in self.leg(start, end)]

    def length(self, stops):
        return float(self.metres[stops[:-1], stops[1:]].sum())

    def line(self, stops):
        """The points of a tour, one beside the other; two at least."""
        outlooks = self.passed(stops)
        points = [self.outlooks[outlooks[0]].tolist()]
        for start, end in zip(outlooks, outlooks[1:]):
            way = self.ways.get((start, end))
            points += (way["points"] if way else self.ways[end, start]["points"][::-1])[1:]
        return points if len(points) > 1 else 2 * points

    def gains_of(self, voxels):
        """Litres that each outlook sees of some voxels."""
        rows = self.seers[voxels]
        weights = np.repeat(self.litres[voxels], np.diff(rows.indptr))
        return np.bincount(rows.indices, weights, minlength=len(self.outlooks))


class Tour:
    """A closed tour from the start; keeps what it sees and what every outlook would add."""

    def __init__(self, survey):
        self.survey = survey
        self.stops = [0, 0]
        self.passed = collections.Counter([0])
        self.times_seen = np.zeros(len(survey.litres), dtype=np.int32)
        self.times_seen[survey.seen[0]] = 1
        self.gains = survey.gains_of(np.flatnonzero(self.times_seen == 0))

    @property
    def volume(self):
        """Litres seen from the outlooks it leads past."""
        return float(self.survey.litres[self.times_seen > 0].sum())

    @property
    def length(self):
        return self.survey.length(self.stops)

    def copy(self):
        other = copy.copy(self)
        other.stops, other.passed = list(self.stops), self.passed.copy()
        other.times_seen, other.gains = self.times_seen.copy(), self.gains.copy()
        return other

    def follow(self, stops):
        """Becomes the tour through these stops, the start first and last."""
        passed = collections.Counter(self.survey.passed(stops))
        left_out, added = self.passed - passed, passed - self.passed
        self.stops, self.passed = list(stops), passed
        rows = [self.survey.seen[outlook] for outlook in sorted({*left_out, *added})]
        if not rows:
            return
        changed = np.unique(np.concatenate(rows))
        was_seen = self.times_seen[changed] > 0
        for outlooks, sign in ((left_out, -1), (added, 1)):
            for outlook, times in outlooks.items():
                self.times_seen[self.survey.seen[outlook]] += sign * times
        is_seen = self.times_seen[changed] > 0
        self.gains -= self.survey.gains_of(changed[~was_seen & is_seen])
        self.gains += self.survey.gains_of(changed[was_seen & ~is_seen])

    def loss(self, outlook):
        """Litres that are seen from one outlook only, passed once, and from nowhere else."""
        voxels = self.survey.seen[outlook]
        return float(self.survey.litres[voxels[self.times_seen[voxels] == 1]].sum())
