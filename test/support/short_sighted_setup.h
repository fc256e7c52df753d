#pragma once

#include "spelunk/evaluation/mission_run.h"

namespace spelunk::test {

/// A run of a robot whose LiDAR sees 8 m, so that a room has to be flown through to be seen.
inline evaluation::RunSetup shortSightedSetup(const Pose& start, double time_limit_s) {
  evaluation::RunSetup setup;
  SensorModel sensor;
  sensor.rows = 16;
  sensor.columns = 360;
  sensor.range_max_m = 8.0;
  sensor.gain_range_m = 8.0;
  setup.robot.sensor_models = {sensor};
  setup.map.range_max_m = 8.0;
  setup.start = start;
  setup.time_limit_s = time_limit_s;
  setup.seed = 3;
  return setup;
}

}  // namespace spelunk::test
