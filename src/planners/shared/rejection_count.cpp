#include "spelunk/planners/shared/rejection_count.h"

namespace spelunk::planners {

void count(Rejection rejection, PlanStats& stats) {
  switch (rejection) {
    case Rejection::kNone:
      break;
    case Rejection::kOccupied:
      ++stats.rejected_occupied;
      break;
    case Rejection::kUnknown:
      ++stats.rejected_unknown;
      break;
    case Rejection::kOutOfBounds:
      ++stats.rejected_out_of_bounds;
      break;
    case Rejection::kNoGo:
      ++stats.rejected_no_go;
      break;
    case Rejection::kTooSteep:
      ++stats.rejected_too_steep;
      break;
  }
}

}  // namespace spelunk::planners
