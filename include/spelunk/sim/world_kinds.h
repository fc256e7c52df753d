#pragma once

#include "spelunk/common/params.h"
#include "spelunk/common/rng.h"
#include "spelunk/sim/world_plan.h"

namespace spelunk::sim {

/// Kind "drifts": two headings side by side with crosscuts, gate roads to both sides, faces that
/// join neighbouring gate roads, and short stubs.
struct DriftsParams {
  double heading_length_m = 200.0;
  double heading_spacing_m = 24.0;
  double crosscut_pitch_m = 33.0;
  double gate_pitch_m = 55.0;
  double gate_length_min_m = 65.0;
  double gate_length_max_m = 105.0;
  double face_probability = 0.7;
  double stub_probability = 0.5;
  double stub_length_m = 14.0;
  double width_min_m = 2.0;
  double width_max_m = 4.0;
  double height_min_m = 3.0;
  double height_max_m = 4.0;
  double wander_m = 2.0;
  double relief_m = 1.5;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("heading_length_m", heading_length_m, Bounds{20.0, 1000.0}, "length of both headings");
    field("heading_spacing_m", heading_spacing_m, Bounds{8.0, 100.0}, "between the headings");
    field("crosscut_pitch_m", crosscut_pitch_m, Bounds{10.0, 500.0}, "from crosscut to crosscut");
    field("gate_pitch_m", gate_pitch_m, Bounds{12.0, 500.0}, "from gate road to gate road");
    field("gate_length_min_m", gate_length_min_m, Bounds{5.0, 500.0}, "shortest gate road");
    field("gate_length_max_m", gate_length_max_m, Bounds{5.0, 500.0}, "longest gate road");
    field("face_probability", face_probability, Bounds{0.0, 1.0}, "two gate roads are joined");
    field("stub_probability", stub_probability, Bounds{0.0, 1.0}, "a gate road has a dead end");
    field("stub_length_m", stub_length_m, Bounds{2.0, 100.0}, "length of a dead end");
    field("width_min_m", width_min_m, Bounds{1.8, 20.0}, "narrowest drift");
    field("width_max_m", width_max_m, Bounds{1.8, 20.0}, "widest drift");
    field("height_min_m", height_min_m, Bounds{1.6, 20.0}, "lowest roof");
    field("height_max_m", height_max_m, Bounds{1.6, 20.0}, "highest roof");
    field("wander_m", wander_m, Bounds{0.0, 10.0}, "drifts leave their straight line so far");
    field("relief_m", relief_m, Bounds{0.0, 20.0}, "floors rise and fall so much");
  }
};

/// Kind "rooms": two fields of streets around pillars, one wide and one narrow, joined by a few
/// openings, the last of them the narrowest place.
struct RoomsParams {
  int wide_columns = 9;
  int wide_rows = 8;
  double wide_pitch_m = 18.0;
  double wide_min_m = 5.0;
  double wide_max_m = 7.0;
  int narrow_columns = 11;
  int narrow_rows = 11;
  double narrow_pitch_m = 12.0;
  double narrow_min_m = 2.4;
  double narrow_max_m = 3.8;
  int openings = 3;
  double opening_m = 1.8;
  double height_min_m = 3.2;
  double height_max_m = 4.2;
  double closed_share = 0.12;
  double relief_m = 1.0;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("wide_columns", wide_columns, Bounds{2, 60}, "crossings along x, wide half");
    field("wide_rows", wide_rows, Bounds{2, 60}, "crossings along y, wide half");
    field("wide_pitch_m", wide_pitch_m, Bounds{5.0, 60.0}, "from crossing to crossing");
    field("wide_min_m", wide_min_m, Bounds{1.8, 20.0}, "narrowest room, wide half");
    field("wide_max_m", wide_max_m, Bounds{1.8, 20.0}, "widest room, wide half");
    field("narrow_columns", narrow_columns, Bounds{2, 60}, "crossings along x, narrow half");
    field("narrow_rows", narrow_rows, Bounds{2, 60}, "crossings along y, narrow half");
    field("narrow_pitch_m", narrow_pitch_m, Bounds{5.0, 60.0}, "from crossing to crossing");
    field("narrow_min_m", narrow_min_m, Bounds{1.8, 20.0}, "narrowest room, narrow half");
    field("narrow_max_m", narrow_max_m, Bounds{1.8, 20.0}, "widest room, narrow half");
    field("openings", openings, Bounds{1, 3}, "passages between the halves");
    field("opening_m", opening_m, Bounds{1.8, 20.0}, "the narrowest passage between the halves");
    field("height_min_m", height_min_m, Bounds{1.6, 20.0}, "lowest roof");
    field("height_max_m", height_max_m, Bounds{1.6, 20.0}, "highest roof");
    field("closed_share", closed_share, Bounds{0.0, 0.6}, "streets that were never cut");
    field("relief_m", relief_m, Bounds{0.0, 20.0}, "floors rise and fall so much");
  }
};

/// Kind "cave": chambers on several levels, joined by winding passages.
struct CaveParams {
  double size_x_m = 130.0;
  double size_y_m = 100.0;
  double relief_m = 12.0;
  double chamber_spacing_m = 19.0;
  double chamber_radius_min_m = 2.5;
  double chamber_radius_max_m = 7.0;
  double width_min_m = 1.8;
  double width_max_m = 4.5;
  double height_min_m = 1.8;
  double height_max_m = 4.5;
  double slope_max = 0.45;
  double loop_share = 0.35;
  double wander_m = 3.0;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("size_x_m", size_x_m, Bounds{20.0, 1000.0}, "extent along x");
    field("size_y_m", size_y_m, Bounds{20.0, 1000.0}, "extent along y");
    field("relief_m", relief_m, Bounds{0.0, 100.0}, "floors rise and fall so much");
    field("chamber_spacing_m", chamber_spacing_m, Bounds{5.0, 100.0}, "least between chambers");
    field("chamber_radius_min_m", chamber_radius_min_m, Bounds{1.2, 50.0}, "smallest chamber");
    field("chamber_radius_max_m", chamber_radius_max_m, Bounds{1.2, 50.0}, "largest chamber");
    field("width_min_m", width_min_m, Bounds{1.8, 20.0}, "narrowest passage");
    field("width_max_m", width_max_m, Bounds{1.8, 20.0}, "widest passage");
    field("height_min_m", height_min_m, Bounds{1.6, 20.0}, "lowest passage");
    field("height_max_m", height_max_m, Bounds{1.6, 20.0}, "highest passage");
    field("slope_max", slope_max, Bounds{0.0, 2.0}, "rise over run of a passage");
    field("loop_share", loop_share, Bounds{0.0, 1.0}, "of the possible loops, so many are open");
    field("wander_m", wander_m, Bounds{0.0, 20.0}, "passages leave their straight line so far");
  }
};

/// Kind "ramps": three levels of two headings with crosscuts, one above the other, joined by ramps;
/// and one shaft from the uppermost level to the middle one.
struct RampsParams {
  double level_length_m = 50.0;
  double heading_spacing_m = 20.0;
  double crosscut_pitch_m = 22.0;
  double level_drop_m = 6.0;
  double grade_min_percent = 18.0;
  double grade_max_percent = 36.0;
  double width_min_m = 2.8;
  double width_max_m = 4.0;
  double height_m = 3.0;
  double shaft_m = 3.0;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("level_length_m", level_length_m, Bounds{30.0, 300.0}, "length of the headings");
    field("heading_spacing_m", heading_spacing_m, Bounds{10.0, 100.0}, "between the headings");
    field("crosscut_pitch_m", crosscut_pitch_m, Bounds{10.0, 200.0}, "from crosscut to crosscut");
    field("level_drop_m", level_drop_m, Bounds{4.0, 10.0}, "from level to level");
    field("grade_min_percent", grade_min_percent, Bounds{10.0, 60.0}, "gentlest ramp");
    field("grade_max_percent", grade_max_percent, Bounds{10.0, 60.0}, "steepest ramp");
    field("width_min_m", width_min_m, Bounds{1.8, 8.0}, "narrowest heading");
    field("width_max_m", width_max_m, Bounds{1.8, 8.0}, "widest heading");
    field("height_m", height_m, Bounds{1.8, 3.5}, "floor to roof");
    field("shaft_m", shaft_m, Bounds{2.0, 6.0}, "edge of the shaft");
  }
};

/// Kind "rough": two drifts and three crosscuts with rubble, rails, steps and holes on the floor.
/// Steps that are too high for legs, and all holes, leave a way round on one side; the middle
/// crosscut is closed to legs by the highest step.
struct RoughParams {
  double length_m = 60.0;
  double spacing_m = 18.0;
  double width_m = 4.6;
  double height_m = 3.2;
  double obstacle_pitch_m = 4.5;
  double rubble_max_m = 0.2;
  double step_min_m = 0.05;
  double step_max_m = 0.4;
  double easy_step_m = 0.15;
  double hole_min_m = 0.3;
  double hole_max_m = 1.0;
  double hole_depth_m = 0.8;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("length_m", length_m, Bounds{30.0, 500.0}, "length of both drifts");
    field("spacing_m", spacing_m, Bounds{10.0, 100.0}, "between the drifts");
    field("width_m", width_m, Bounds{4.0, 12.0}, "width of the drifts");
    field("height_m", height_m, Bounds{1.8, 10.0}, "floor to roof");
    field("obstacle_pitch_m", obstacle_pitch_m, Bounds{4.0, 50.0}, "from obstacle to obstacle");
    field("rubble_max_m", rubble_max_m, Bounds{0.05, 0.5}, "highest lump of rubble");
    field("step_min_m", step_min_m, Bounds{0.02, 1.0}, "lowest step");
    field("step_max_m", step_max_m, Bounds{0.02, 1.0}, "highest step");
    field("easy_step_m", easy_step_m, Bounds{0.02, 1.0}, "steps up to it cross the whole drift");
    field("hole_min_m", hole_min_m, Bounds{0.1, 2.0}, "edge of the smallest hole");
    field("hole_max_m", hole_max_m, Bounds{0.1, 2.0}, "edge of the largest hole");
    field("hole_depth_m", hole_depth_m, Bounds{0.1, 3.0}, "depth of holes");
  }
};

/// Kind "room": one room with a pillar and an alcove.
struct RoomParams {
  double size_x_m = 12.0;
  double size_y_m = 10.0;
  double height_m = 4.0;
  double pillar_m = 1.6;
  double alcove_m = 3.0;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("size_x_m", size_x_m, Bounds{4.0, 200.0}, "extent along x");
    field("size_y_m", size_y_m, Bounds{4.0, 200.0}, "extent along y");
    field("height_m", height_m, Bounds{1.6, 50.0}, "floor to roof");
    field("pillar_m", pillar_m, Bounds{0.0, 50.0}, "edge of the pillar; 0: none");
    field("alcove_m", alcove_m, Bounds{0.0, 50.0}, "edge of the alcove; 0: none");
  }
};

/// Kind "maze": corridors along a square grid, a spanning tree and a few loops.
struct MazeParams {
  int columns = 5;
  int rows = 5;
  double pitch_m = 5.0;
  double width_m = 2.5;
  double height_m = 3.0;
  double loop_share = 0.15;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("columns", columns, Bounds{2, 60}, "crossings along x");
    field("rows", rows, Bounds{2, 60}, "crossings along y");
    field("pitch_m", pitch_m, Bounds{3.0, 60.0}, "from crossing to crossing");
    field("width_m", width_m, Bounds{1.8, 20.0}, "free width");
    field("height_m", height_m, Bounds{1.6, 20.0}, "floor to roof");
    field("loop_share", loop_share, Bounds{0.0, 1.0}, "of the walls, so many are open");
  }
};

/// Kind "shafts": two upright shafts joined by a passage at their feet that goes aside, along and
/// back, so that no straight line leads from one to the other. The start belongs into the first, at
/// the origin.
struct ShaftsParams {
  double shaft_m = 2.5;
  double height_m = 4.0;
  double distance_m = 9.0;
  double bend_m = 3.2;
  double passage_width_m = 2.2;
  double passage_height_m = 2.0;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("shaft_m", shaft_m, Bounds{1.8, 20.0}, "edge of both shafts");
    field("height_m", height_m, Bounds{2.0, 100.0}, "height of both shafts");
    field("distance_m", distance_m, Bounds{5.0, 200.0}, "from shaft to shaft along x");
    field("bend_m", bend_m, Bounds{0.0, 50.0}, "the passage goes so far aside");
    field("passage_width_m", passage_width_m, Bounds{1.8, 20.0}, "width of the passage");
    field("passage_height_m", passage_height_m, Bounds{1.6, 20.0}, "height of the passage");
  }
};

/// Kind "walls": one room with walls from floor to roof, along x and y in turn, that leave gaps on
/// all sides. Its corner with the least x and y is the origin; the start's surroundings stay free.
struct WallsParams {
  double size_x_m = 40.0;
  double size_y_m = 30.0;
  double height_m = 4.0;
  int walls = 15;
  double length_min_m = 3.0;
  double length_max_m = 8.0;
  double thickness_m = 0.5;
  double gap_m = 2.2;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("size_x_m", size_x_m, Bounds{8.0, 200.0}, "extent along x");
    field("size_y_m", size_y_m, Bounds{8.0, 200.0}, "extent along y");
    field("height_m", height_m, Bounds{1.6, 50.0}, "floor to roof");
    field("walls", walls, Bounds{0, 1000}, "how many");
    field("length_min_m", length_min_m, Bounds{0.5, 50.0}, "shortest wall");
    field("length_max_m", length_max_m, Bounds{0.5, 50.0}, "longest wall");
    field("thickness_m", thickness_m, Bounds{0.3, 5.0}, "of the walls");
    field("gap_m", gap_m, Bounds{1.0, 20.0}, "least between walls, and to the sides");
  }
};

/// Kind "levels": a mine of several levels, one above the other, each a network of winding drifts
/// between jittered crossings; neighbouring levels are joined by upright shafts at crossings.
struct LevelsParams {
  int levels = 4;
  double level_drop_m = 18.0;
  int columns = 6;
  int rows = 4;
  double pitch_x_m = 42.0;
  double pitch_y_m = 34.0;
  double width_min_m = 2.4;
  double width_max_m = 5.5;
  double height_min_m = 2.4;
  double height_max_m = 5.0;
  double wander_m = 4.0;
  double relief_m = 4.0;
  double loop_share = 0.4;
  double shaft_m = 4.5;
  int shafts = 2;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("levels", levels, Bounds{1, 20}, "how many");
    field("level_drop_m", level_drop_m, Bounds{6.0, 100.0}, "from level to level");
    field("columns", columns, Bounds{2, 60}, "crossings along x");
    field("rows", rows, Bounds{2, 60}, "crossings along y");
    field("pitch_x_m", pitch_x_m, Bounds{8.0, 200.0}, "from crossing to crossing along x");
    field("pitch_y_m", pitch_y_m, Bounds{8.0, 200.0}, "from crossing to crossing along y");
    field("width_min_m", width_min_m, Bounds{1.8, 20.0}, "narrowest drift");
    field("width_max_m", width_max_m, Bounds{1.8, 20.0}, "widest drift");
    field("height_min_m", height_min_m, Bounds{1.6, 20.0}, "lowest roof");
    field("height_max_m", height_max_m, Bounds{1.6, 20.0}, "highest roof");
    field("wander_m", wander_m, Bounds{0.0, 20.0}, "drifts leave their straight line so far");
    field("relief_m", relief_m, Bounds{0.0, 20.0}, "floors rise and fall so much");
    field("loop_share", loop_share, Bounds{0.0, 1.0}, "of the possible loops, so many are open");
    field("shaft_m", shaft_m, Bounds{2.0, 20.0}, "edge of the shafts");
    field("shafts", shafts, Bounds{1, 100}, "from each level to the next");
  }
};

/// Add the spaces of a kind to a plan whose seed and start are set; the floor is near z = 0 at the
/// start.
void layOut(const DriftsParams& params, WorldPlan& plan);
void layOut(const RoomsParams& params, WorldPlan& plan);
void layOut(const CaveParams& params, WorldPlan& plan);
void layOut(const RampsParams& params, WorldPlan& plan);
void layOut(const RoughParams& params, WorldPlan& plan);
void layOut(const RoomParams& params, WorldPlan& plan);
void layOut(const MazeParams& params, WorldPlan& plan);
void layOut(const ShaftsParams& params, WorldPlan& plan);
void layOut(const WallsParams& params, WorldPlan& plan);
void layOut(const LevelsParams& params, WorldPlan& plan);

}  // namespace spelunk::sim
