#include "spelunk/common/rng.h"

#include <gtest/gtest.h>

#include "spelunk/common/contract.h"

namespace spelunk {
namespace {

TEST(Rng, DrawsTheReferenceSequenceOfSplitmix64) {
  Rng rng(1234567);
  EXPECT_EQ(rng.next(), 6457827717110365317ULL);
  EXPECT_EQ(rng.next(), 3203168211198807973ULL);
}

TEST(Rng, ForksByNameAndDoesNotAdvance) {
  Rng run(9);
  EXPECT_EQ(run.fork("lidar").next(), run.fork("lidar").next());
  EXPECT_NE(run.fork("lidar").next(), run.fork("planner").next());
  EXPECT_EQ(run.next(), Rng(9).next());
}

TEST(Rng, NormalHasMeanZeroAndVarianceOne) {
  Rng rng(5);
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kDraws = 100000;
  for (int i = 0; i < kDraws; ++i) {
    const double draw = rng.normal();
    sum += draw;
    squares += draw * draw;
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 0.015);
  EXPECT_NEAR(squares / kDraws, 1.0, 0.02);
}

TEST(Rng, BelowCoversItsRangeAndRefusesAnEmptyOne) {
  Rng rng(5);
  int seen = 0;
  for (int i = 0; i < 200; ++i) seen |= 1 << rng.below(6);
  EXPECT_EQ(seen, 0b111111);
  EXPECT_THROW(rng.below(0), Precondition);
}

}  // namespace
}  // namespace spelunk
