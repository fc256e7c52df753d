#pragma once

#include <deque>
#include <optional>
#include <string>

#include "spelunk/common/local_frame.h"
#include "spelunk/common/pose.h"
#include "spelunk/common/robot_model.h"

namespace spelunk::mission {

/// Keeps the frame of a mission with the robot while the caller's odometry is corrected: the loop
/// closure of somebody's SLAM moves the robot in the caller's frame by more than it can have moved.
///
/// The model: the whole past moves rigidly with the correction, so that the robot's near past fits.
/// In the mission's own frame nothing moves then: map, trail, graphs, marked zones, home, and the
/// bounds and zones that people gave stay where they are against the robot; only this frame is
/// shifted against the caller's, and turned about z. The older part of the trail was displaced
/// before the correction and stays so: the robot comes home by what it sees on its way.
///
/// The owner of a mission converts with it all that goes into the mission and comes out of it.
class MissionFrame {
 public:
  /// `resolution_m`: of the map; smaller corrections are no more to it than noise.
  MissionFrame(const RobotModel& robot, double resolution_m);

  [[nodiscard]] const LocalFrame& now() const { return now_; }
  /// The frame that a mission begins in.
  void place(const LocalFrame& frame);

  /// Takes up odometry in the caller's frame, stamped in mission time, and shifts the frame if it
  /// was corrected. Odometry that is too far off even for that leaves the frame as it is: the
  /// mission itself doubts it. A sentence about the correction; none if there was none.
  [[nodiscard]] std::optional<std::string> take(const RobotState& report);
  /// The newest correction: what was at p in the caller's frame is at `correction()(p)` now.
  [[nodiscard]] const Shift& correction() const { return correction_; }
  [[nodiscard]] int corrections() const { return corrections_; }

  /// In which frame something was measured: that of its time, for the caller's frame may have been
  /// corrected since. None in the gap between two reports of odometry with a correction between
  /// them: nobody knows on which side of it.
  [[nodiscard]] std::optional<LocalFrame> at(double stamp_s) const;
  /// What comes in from now on is in the caller's frame as it is now, whenever it was measured.
  void forgetPast() { past_.clear(); }

 private:
  struct Past {
    LocalFrame frame;
    double until_s = 0.0;      ///< The last report in it.
    double corrected_s = 0.0;  ///< The first report after it.
  };

  [[nodiscard]] Pose predicted(const RobotState& report) const;
  [[nodiscard]] bool isMotion(const Pose& predicted, const RobotState& report) const;
  [[nodiscard]] bool isPlausible(const Pose& predicted, const RobotState& report);

  RobotModel robot_;
  double slack_m_;
  LocalFrame now_;
  std::deque<Past> past_;
  std::optional<RobotState> last_;  ///< Caller's frame.
  double travelled_m_ = 0.0;
  Shift correction_;
  int corrections_ = 0;
  std::deque<double> corrected_s_;  ///< Of late.
};

}  // namespace spelunk::mission
