#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/rng.h"
#include "spelunk/mission/basis.h"
#include "spelunk/mission/home_graph.h"
#include "spelunk/mission/way_home_search.h"
#include "spelunk/navigation/path_monitor.h"
#include "spelunk/planners/exploration_planner.h"

namespace spelunk::mission {

/// A way home that is known, and how long it takes, not pessimistic.
struct KnownWay {
  Path path;
  double travel_s = 0.0;
  bool follows_active = false;  ///< Begins with the rest of the active path.
};

/// The ways home: the robot's own trail and its short cuts, and the planner's way from the end of
/// the path that is flown. It keeps the best one up to date, says what a path may cost so that one
/// is left, and chooses how home is flown.
///
/// Nothing may be asked but isKnown() before begin() or takeUp().
class WayHome {
 public:
  /// A way that begins farther off does not begin where the robot is.
  static constexpr double kBeginsHere_m = 1.0;

  explicit WayHome(const Basis& basis) : basis_(basis) {}

  // --- Home and the trail.
  void begin();  ///< Home is here.
  void takeUp(const Path& trail, const std::vector<NoGoZone>& marked_zones);
  [[nodiscard]] bool isKnown() const { return graph_.has_value(); }
  [[nodiscard]] const Pose& home() const { return graph_->home(); }
  [[nodiscard]] const Path& trail() const { return graph_->trail(); }
  [[nodiscard]] const std::vector<planners::StampedPose>& stampedTrail() const { return stamped_; }
  [[nodiscard]] bool isAtHome() const;
  /// Takes up where the robot is. True if the trail has grown.
  bool noteOdometry();

  // --- What changes the ways.
  void noteZone(const NoGoZone& zone) { graph_->noteZone(zone); }
  void noteOccupied(const std::vector<map::VoxelIndex>& voxels, double now_s);
  void connect(const std::shared_ptr<const map::FrozenMap>& map) { graph_->connect(map); }
  /// `rest`: of the planner's path, beyond what is flown of it; `home`: from its end.
  void noteRoute(const Path& rest, const planners::PlanResult& home);
  void forgetRoute() { route_.reset(); }

  // --- The best way that is known.
  [[nodiscard]] bool isDue(double now_s) const { return isKnown() && now_s >= next_refresh_s_; }
  void refreshAt(double time_s) { next_refresh_s_ = time_s; }
  /// Finds the best way anew. False if none is known: the last one stays.
  bool refresh(double now_s);
  /// While the robot flies home, the way home is what it flies.
  void followActive(double now_s);
  [[nodiscard]] const Path& path() const { return way_; }
  /// Whether it was clear when it was looked for last.
  [[nodiscard]] bool isClear() const { return is_clear_; }
  [[nodiscard]] double travel_s() const { return way_s_; }
  /// remaining - reserve - pessimistic way home, seconds; negative: the invariant is broken.
  [[nodiscard]] double margin_s() const { return basis_.endurance.guard().margin(way_s_); }
  /// Metres of a path, from its start, that may be flown so that a way home is left: back along it,
  /// or on along it and by `home_path` from its end, if there is one.
  [[nodiscard]] double affordableLength(const Path& path,
                                        const std::optional<Path>& home_path) const;

  /// Time to fly a path from rest to rest, not pessimistic; its narrow places are flown slowly.
  [[nodiscard]] double travelTime(const Path& path) const;

  // --- Flying home.
  /// How to fly home from here and now; none if all known ways are blocked: see obstacle().
  [[nodiscard]] std::optional<Leg> findLeg(double now_s);
  /// What lay between the robot and home at the last try, one sentence.
  [[nodiscard]] const std::string& obstacle() const { return obstacle_; }
  /// The leg for a planner's way home, `whole` from the robot on; none if the way that is known is
  /// better, or safer.
  [[nodiscard]] std::optional<Leg> legOfSeenWay(const Path& whole, double now_s);

  // --- Another way home when the trail is cut.
  /// What navigation is to look for: ways with the full safety box first, then ways with the tight
  /// box that is allowed where the robot has flown. `stream`: name of the stream of `rng` that the
  /// queries draw from.
  [[nodiscard]] WayHomeSearch search(const Pose& from,
                                     const std::shared_ptr<const map::FrozenMap>& map,
                                     const Rng& rng, const std::string& stream);
  /// The leg along a way that such a search found, and from its end on along the trail; none if it
  /// cannot be flown now.
  [[nodiscard]] std::optional<Leg> legOfFoundWay(const planners::PlanResult& found);

 private:
  /// A planner's way home that was checked, beginning at the end of the active path.
  struct Route {
    Path path;
    double travel_s = 0.0;
    navigation::PathMonitor monitor;
  };

  [[nodiscard]] std::optional<KnownWay> wayByTrail();
  [[nodiscard]] std::optional<KnownWay> wayByRoute(double now_s) const;
  void mergeIfWorth(const KnownWay& by_route, const KnownWay& by_trail, double now_s);
  [[nodiscard]] Path fromMotion(const KnownWay& way, double now_s) const;
  /// A way home that was only seen may prove blocked. Whether there is time to find that out at its
  /// end, to come back and to fly the `known` one, or that one is cut or takes too long anyway.
  [[nodiscard]] bool isWorthTheRisk(double travel_s, const std::optional<KnownWay>& known);
  [[nodiscard]] std::optional<Pose> findPlaceAtHome(const Eigen::Vector3d& box);
  [[nodiscard]] std::vector<Pose> placesOnTrail();
  [[nodiscard]] std::string whatBlocks();
  [[nodiscard]] Eigen::Vector3d tightBox() const { return HomeGraph::tightBox(basis_.robot.box_m); }

  Basis basis_;
  std::optional<HomeGraph> graph_;
  std::vector<planners::StampedPose> stamped_;
  std::optional<Route> route_;
  Path way_;
  double way_s_ = 0.0;
  bool is_clear_ = true;
  double next_refresh_s_ = 0.0;
  double next_merge_s_ = 0.0;
  std::string obstacle_;
};

}  // namespace spelunk::mission
