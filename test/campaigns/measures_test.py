"""Numbers of reports against numbers made by hand."""
import itertools
import pathlib
import unittest

import numpy as np
import pandas

import support
from campaigns import measures, page, results


def run(seed, volumes, plans_ms=(), distances=None, **summary):
    """A run with one explored volume a second, without a folder."""
    seconds = np.arange(1.0, len(volumes) + 1)
    made = results.Run(pathlib.Path(), {"seed": seed},
                       {"explored_volume_m3": volumes[-1], "returned_home": True,
                        "remaining_at_home_s": 5.0, **summary})
    made.__dict__["timeline"] = pandas.DataFrame({
        "t_s": seconds, "explored_m3": volumes, "distance_m": distances or seconds})
    made.__dict__["plans"] = pandas.DataFrame({"wall_ms": list(plans_ms)})
    return made


def series(label, finals, seeds=None):
    """Runs that explore ever the same amount a second."""
    return results.Series(label, label, tuple(
        run(seed, [final / 2, final]) for seed, final in zip(seeds or itertools.count(1), finals)))


class OneRun(unittest.TestCase):
    def test_time_to_a_volume_is_the_first_second_that_has_it(self):
        flown = run(1, [10, 40, 40, 90])
        self.assertEqual([measures.time_to(flown, volume) for volume in (5, 40, 41, 90)],
                         [1, 2, 4, 4])
        self.assertEqual(measures.time_to(flown, 90.1), np.inf)

    def test_a_run_that_ended_early_keeps_its_volume(self):
        volumes = measures.explored_at(run(1, [10, 30]), np.array([0, 0.5, 1, 1.5, 2, 7]))
        self.assertEqual(volumes.tolist(), [0, 5, 10, 20, 30, 30])
        self.assertAlmostEqual(measures.mean_explored(run(1, [10, 30]), 4), (0 + 10 + 90) / 5)

    def test_the_working_rate_ends_at_nine_tenths_of_the_own_volume(self):
        self.assertEqual(measures.working_rate(run(1, [50, 90, 95, 100])), 90 / 2)

    def test_standing_is_no_navigation(self):
        flown = run(1, [1] * 5, distances=[0.0, 1.0, 1.01, 1.5, 1.5])
        self.assertEqual(measures.navigation_time(flown), 2)

    def test_home_without_reserve_does_not_count(self):
        self.assertTrue(measures.is_home_with_reserve(run(1, [1])))
        self.assertFalse(measures.is_home_with_reserve(run(1, [1], remaining_at_home_s=0.0)))
        self.assertFalse(measures.is_home_with_reserve(run(1, [1], returned_home=False)))


class OneSeries(unittest.TestCase):
    def test_the_median_run_is_the_lower_one_of_two(self):
        self.assertEqual(measures.median_run(series("a", [30, 10, 20])).seed, 3)
        self.assertEqual(measures.median_run(series("a", [40, 10, 30, 20])).seed, 4)

    def test_runs_that_never_came_so_far_are_endless(self):
        flown = results.Series("a", "a", (run(1, [10, 90]), run(2, [90]), run(3, [10])))
        self.assertEqual(page.time_to_share(flown, 90), {"seconds": "2", "reached": 2, "runs": 3})
        self.assertEqual(page.time_to_share(flown, 91)["seconds"], "–")

    def test_plan_times_are_those_of_all_runs(self):
        flown = results.Series("a", "a", (run(1, [1], [1, 5]), run(2, [1], [3])))
        self.assertEqual(sorted(measures.plan_times_ms(flown)), [1, 3, 5])


class Pairing(unittest.TestCase):
    @staticmethod
    def final(flown):
        return flown.summary["explored_volume_m3"]

    def test_only_seeds_that_both_flew_are_compared(self):
        pair = measures.paired(series("a", [10, 20, 30], [1, 2, 3]),
                               series("b", [25, 100, 1], [3, 7, 2]), self.final)
        self.assertEqual((pair.first, pair.second, pair.seeds, pair.wins), ("a", "b", 2, 2))
        self.assertEqual(pair.mean, ((20 - 1) + (30 - 25)) / 2)
        self.assertIsNone(measures.paired(series("a", [1], [1]), series("b", [1], [2]), self.final))

    def test_effect_size_is_mean_over_standard_deviation(self):
        differences = np.array([1.0, 2, 3, 4, 5])  # variance (4 + 1 + 0 + 1 + 4) / 4
        self.assertAlmostEqual(measures.effect_size(differences), 3 / np.sqrt(2.5))
        self.assertTrue(np.isnan(measures.effect_size(np.full(5, 2.0))))
        self.assertTrue(np.isnan(measures.effect_size(differences[:4])))

    def test_the_interval_agrees_with_every_resample_enumerated(self):
        differences = np.array([-3.0, -1.0, 0.0, 1.0, 3.0])  # symmetric: BCa is the percentiles
        means = [np.mean(sample) for sample in itertools.product(differences, repeat=5)]
        low, high = measures.interval_of_mean(differences)
        self.assertAlmostEqual(low, np.percentile(means, 2.5), delta=0.11)
        self.assertAlmostEqual(high, np.percentile(means, 97.5), delta=0.11)

    def test_the_interval_repeats_and_shifts_with_the_data(self):
        differences = np.array([4.0, 9.0, 1.0, 7.0, 3.0, 6.0])
        low, high = measures.interval_of_mean(differences)
        self.assertEqual((low, high), measures.interval_of_mean(differences))
        shifted = measures.interval_of_mean(differences - 100)
        self.assertAlmostEqual(shifted[0], low - 100)
        self.assertTrue(0 < low < differences.mean() < high)

    def test_no_interval_where_it_says_nothing(self):
        for differences in ([1.0, 2.0, 3.0, 4.0], [2.0] * 9):
            self.assertTrue(np.isnan(measures.interval_of_mean(np.array(differences))[0]))

    def test_every_two_series_make_a_pair(self):
        three = [series(label, [1, 2]) for label in "abc"]
        pairs = measures.all_pairs(three, self.final)
        self.assertEqual([pair.first + pair.second for pair in pairs], ["ab", "ac", "bc"])


class Texts(unittest.TestCase):
    def test_spread(self):
        self.assertEqual(page.spread([1000.4]), "1,000")
        self.assertEqual(page.spread([]), "–")
        self.assertEqual(page.spread([1, 2, 6], 1), "3.0<br><small>1.0 to 6.0</small>")


if __name__ == "__main__":
    unittest.main()
