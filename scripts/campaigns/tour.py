"""Lays out a tour through a world that is known: which outlooks, in which order.

    python3 -m campaigns.tour FOLDER --time-limit-s T [--out DIR] [--speed-share S]
                             [--way-home {flown,any}]

Reads survey.json and survey_seen.bin, writes tour_points.csv (x_m,y_m,z_m) and tour.json. This is
an orienteering problem whose prize is a volume that many outlooks share. It begins with the outlooks
that are worth most a metre of detour. Then, again and again, a part of the tour is given up, the
rest is ordered anew by the routing solver of OR-tools, and what this leaves of the way is spent on
the detours that are worth most now (ruin and recreate). Of all tours that are home in time the one
that sees most is kept. The same survey gives the same tour.

With --way-home flown the robot relies on no way that it has not flown: from every outlook of the
tour the way home along what was flown until then must fit, too. With any it may hope to see the
rest of its tour before it needs it.
"""
import argparse
import collections
import heapq
import json
import math
import pathlib
import random
import sys

import numpy as np
from ortools.constraint_solver import pywrapcp, routing_enums_pb2
from ortools.constraint_solver.routing_enums_pb2 import LocalSearchMetaheuristic as Search

from campaigns.survey import LITRES_PER_M3, Survey, SurveyError, Tour

WORTH_SHARE = 0.0003            # of all there is to see; less is no reason to fly anywhere
EXPONENTS = (0.7, 1.0, 1.5, 2.0)  # of the gain, against the detour
ROUNDS = 100
GIVEN_UP = (0.05, 0.35)         # share of the stops, least and most
REFUSALS = 12                   # of detours from which it is too far home; then no more are tried
TOLERANCE = 0.004               # of the best volume; a tour that sees so much less may lead on
SEED = 1
SPEED_SHARE = 0.85              # of full speed, corners and all
RESERVE_S = 25.0
RESERVE_SHARE = 0.04
SOLUTIONS = 2000                # a count, so that the same survey gives the same tour
SEARCH_MAX_S = 600              # a last resort


def worth_flying(tour, litres):
    return litres >= WORTH_SHARE * tour.survey.litres.sum()


def detours(tour):
    """Extra metres of every outlook in each gap between two stops."""
    metres, stops = tour.survey.metres, tour.stops
    legs = metres[stops]
    return legs[:-1] + legs[1:] - metres[stops[:-1], stops[1:]][:, None]


class FlownWays:
    """The ways between outlooks that were flown, and how far it is home along them."""

    def __init__(self):
        self.home, self.legs = {0: 0.0}, collections.defaultdict(dict)

    def add(self, start, end, metres):
        """From an outlook that was reached to the next."""
        self.legs[start][end] = self.legs[end][start] = metres
        shortened = [(self.home[start] + metres, end)]
        if end in self.home:
            shortened.append((self.home[end] + metres, start))
        while shortened:
            far, outlook = heapq.heappop(shortened)
            if far >= self.home.get(outlook, math.inf):
                continue
            self.home[outlook] = far
            for other, leg in self.legs[outlook].items():
                heapq.heappush(shortened, (far + leg, other))


def commitment(survey, stops):
    """The longest that, anywhere on a tour, what was flown and the way home along it are; m."""
    ways, flown, longest = FlownWays(), 0.0, 0.0
    outlooks = survey.passed(stops)
    for start, end in zip(outlooks, outlooks[1:]):
        metres = float(survey.metres[start, end])
        flown += metres
        ways.add(start, end, metres)
        longest = max(longest, flown + ways.home[end])
    return longest


class Budget:
    """How long a tour may be, and how far its robot may be from home by the ways it knows; m."""

    def __init__(self, metres, is_home_flown):
        self.metres, self.commitment = metres, metres if is_home_flown else math.inf

    def allows(self, survey, stops):
        """Whether each outlook leaves time for the way home that is known there."""
        return math.isinf(self.commitment) or commitment(survey, stops) <= self.commitment

    def allows_either(self, survey, stops):
        """The same, forth or back."""
        return self.allows(survey, stops) or self.allows(survey, stops[::-1])


def extend(tour, budget, exponent):
    """Adds the detours that are worth most a metre, as many as fit."""
    refused = []
    while len(refused) < REFUSALS:
        every = detours(tour)
        extra = every.min(axis=0)
        fits = worth_flying(tour, tour.gains) & (tour.length + extra <= budget.metres)
        fits[refused] = False
        if not fits.any():
            return
        worth = np.where(fits, np.maximum(tour.gains, 0.0) ** exponent / np.maximum(extra, 0.1), -1)
        best = int(np.argmax(worth))
        place = int(np.argmin(every[:, best])) + 1
        longer = tour.stops[:place] + [best] + tour.stops[place:]
        if budget.allows_either(tour.survey, longer):
            tour.follow(longer)
        else:
            refused.append(best)


def drop_idle(tour):
    """Leaves out the stops without which hardly anything is missed."""
    for outlook in tour.stops[-2:0:-1]:
        if not worth_flying(tour, tour.loss(outlook)):
            tour.follow([stop for stop in tour.stops if stop != outlook] if outlook else tour.stops)


def give_up(tour, rng):
    """Leaves out a part of the tour: the stops around one of them, or a run of them."""
    inner = np.array(tour.stops[1:-1])
    if not inner.size:
        return
    share = GIVEN_UP[0] + (GIVEN_UP[1] - GIVEN_UP[0]) * rng.random()
    centre = int(rng.random() * inner.size)
    is_around = rng.random() < 0.5
    far = tour.survey.metres[inner[centre], inner] if is_around \
        else np.abs(np.arange(inner.size) - centre)
    lost = np.argsort(far, kind="stable")[:max(1, int(share * inner.size))]
    tour.follow([0, *np.delete(inner, lost).tolist(), 0])


def search_parameters(metaheuristic):
    search = pywrapcp.DefaultRoutingSearchParameters()
    search.first_solution_strategy = (
        routing_enums_pb2.FirstSolutionStrategy.PARALLEL_CHEAPEST_INSERTION)
    search.local_search_metaheuristic = metaheuristic
    search.solution_limit = SOLUTIONS
    search.time_limit.FromSeconds(SEARCH_MAX_S)
    return search


def ordered(survey, stops, metaheuristic):
    """The shortest closed tour through the stops that the solver finds, never a longer one."""
    nodes = list(dict.fromkeys(stops))
    if len(nodes) < 4:  # there is one order only
        return stops
    centimetres = np.round(100 * survey.metres[np.ix_(nodes, nodes)]).astype(int)
    manager = pywrapcp.RoutingIndexManager(len(nodes), 1, 0)
    routing = pywrapcp.RoutingModel(manager)
    routing.SetArcCostEvaluatorOfAllVehicles(routing.RegisterTransitMatrix(centimetres.tolist()))
    parameters = search_parameters(metaheuristic)
    routing.CloseModelWithParameters(parameters)
    known = routing.ReadAssignmentFromRoutes([list(range(1, len(nodes)))], True)
    solution = routing.SolveFromAssignmentWithParameters(known, parameters)
    found, index = [], routing.Start(0)
    while not routing.IsEnd(index):
        found.append(nodes[manager.IndexToNode(index)])
        index = solution.Value(routing.NextVar(index))
    found.append(nodes[0])
    return found if survey.length(found) <= survey.length(stops) else stops


def reorder(tour, budget, metaheuristic):
    """The same stops in a shorter order, if that is safe."""
    shorter = ordered(tour.survey, tour.stops, metaheuristic)
    if budget.allows_either(tour.survey, shorter):
        tour.follow(shorter)


def begun(survey, budget):
    """The best of some greedy tours."""
    found = []
    for exponent in EXPONENTS:
        tour = Tour(survey)
        extend(tour, budget, exponent)
        reorder(tour, budget, Search.GREEDY_DESCENT)
        extend(tour, budget, exponent)
        found.append(tour)
    return max(found, key=lambda tour: tour.volume)


def improved(tour, budget):
    """The best tour that ruin and recreate finds from this one."""
    rng, survey = random.Random(SEED), tour.survey
    best = current = tour
    for _ in range(ROUNDS):
        trial = current.copy()
        give_up(trial, rng)
        extend(trial, budget, EXPONENTS[int(rng.random() * len(EXPONENTS))])
        drop_idle(trial)
        reorder(trial, budget, Search.GREEDY_DESCENT)
        extend(trial, budget, 1.0)
        if not budget.allows_either(survey, trial.stops):
            continue
        if trial.volume >= (1.0 - TOLERANCE) * best.volume:
            current = trial
        if (trial.volume, -trial.length) > (best.volume, -best.length):
            best = trial
    return best


def earliness(survey, stops):
    """How early a tour sees what it sees: what is seen at each outlook, summed up."""
    seen = np.zeros(len(survey.litres), dtype=bool)
    total = 0.0
    for outlook in survey.passed(stops):
        seen[survey.seen[outlook]] = True
        total += float(survey.litres[seen].sum())
    return total


def metres_in(survey, time_limit_s, speed_share):
    """Metres that can be flown in time."""
    seconds = (1.0 - RESERVE_SHARE) * time_limit_s - RESERVE_S
    return max(0.0, speed_share * survey.speed_mps * seconds)


def lay_out(survey, budget):
    """The best tour found within a budget, in the direction that sees earlier."""
    tour = improved(begun(survey, budget), budget)
    allowed = [stops for stops in (tour.stops, tour.stops[::-1]) if budget.allows(survey, stops)]
    tour.follow(max(allowed, key=lambda stops: earliness(survey, stops)))
    return tour


def write(tour, budget_m, folder):
    lines = ["x_m,y_m,z_m"] + [",".join(f"{value:.3f}" for value in point)
                               for point in tour.survey.line(tour.stops)]
    (folder / "tour_points.csv").write_text("\n".join(lines) + "\n")
    (folder / "tour.json").write_text(json.dumps({
        "outlooks": len(tour.stops) - 2, "length_m": round(tour.length, 3),
        "budget_m": round(budget_m, 3), "speed_mps": tour.survey.speed_mps,
        "seen_m3": tour.volume / LITRES_PER_M3,
        "to_see_m3": float(tour.survey.litres.sum()) / LITRES_PER_M3,
        "is_cut": bool(worth_flying(tour, tour.gains).any())}, indent=2) + "\n")


def main():
    parser = argparse.ArgumentParser(prog="tour", description=__doc__.split("\n\n")[0])
    parser.add_argument("folder", type=pathlib.Path, help="where the survey is")
    parser.add_argument("--out", type=pathlib.Path, help="where the tour goes; beside the survey")
    parser.add_argument("--time-limit-s", type=float, required=True)
    parser.add_argument("--speed-share", type=float, default=SPEED_SHARE,
                        help="of full speed, corners and all")
    parser.add_argument("--way-home", choices=("flown", "any"), default="flown",
                        help="what the robot may rely on")
    options = parser.parse_args()
    try:
        survey = Survey(options.folder)
    except SurveyError as error:
        print(f"tour: {error}", file=sys.stderr)
        return 2
    budget_m = metres_in(survey, options.time_limit_s, options.speed_share)
    tour = lay_out(survey, Budget(budget_m, options.way_home == "flown"))
    write(tour, budget_m, options.out or options.folder)
    print(f"tour: {len(tour.stops) - 2} outlooks, {tour.length:.0f} of {budget_m:.0f} m, "
          f"{tour.volume / LITRES_PER_M3:.0f} of {survey.litres.sum() / LITRES_PER_M3:.0f} m3")
    return 0


if __name__ == "__main__":
    sys.exit(main())
