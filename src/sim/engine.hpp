// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "resect/simulation.hpp"

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "cut/cutter.hpp"
#include "cut/saved_state.hpp"
#include "fem/elements.hpp"
#include "fem/packing.hpp"
#include "fem/step.hpp"

namespace resect {

inline constexpr double safety_factor = 0.6;        // of the rest bound (docs/method.md, "The step")
inline constexpr double viscous_share = 0.1;        // automatic viscous time over the rest bound
inline constexpr std::int64_t check_interval = 100; // steps between two looks at the strain
inline constexpr std::int64_t bound_shares = 50;    // looks that it takes to see every copy's live bound

/// Constant after creation.
struct Model {
    TetMesh elements = {};
    std::vector<RestElement> rest = {}; // [element]
    std::vector<Index> region = {};     // [element] row of Tissue::materials
    std::vector<std::pair<Index, Vec3>> loads = {};
    Weights weights = Weights::fraction;
    Quantities quantities = Quantities::copy;
    double asked_time_step = 0; // s; 0: chosen
    bool allow_unstable_step = false;
    double size = 0;         // diagonal of the rest box, m
    double element_size = 0; // cube root of the mean element's volume, m
    std::uint64_t hash = 0;  // of all that a snapshot must have in common
};

/// What the body is made of, and the step that follows from it.
struct Tissue {
    std::vector<Material> materials = {};
    std::vector<double> viscous_time = {}; // [material] s
    double rest_bound = 0, time_step = 0;  // s
    double load_per_gravity = 0;           // s^2/m, see measure_load_per_gravity
};

/// A blade on its way: poses that the next steps have yet to sweep, in order.
struct BladeWay {
    Index blade = 0;
    Edge at = {};
    Edge before = {}; // where it was before it moved last
    std::vector<Edge> poses = {};
    double begun = 0; // share of the way from the pose before to poses.front() that is behind it
};

/// A node that follows a grasp: its displacement less where the grasp is, m.
struct GraspedNode {
    Index node = 0;
    Vec3 offset = {};
};

struct GraspWay {
    Index grasp = 0;
    Vec3 at = {}, to = {}; // m
    double radius = 0;     // m
    std::vector<GraspedNode> nodes = {};
};

/// What left the motion, J.
struct Work {
    double internal = 0; // taken by the internal forces, elastic and viscous together
    double damping = 0;  // by mass-proportional damping
    double settling = 0; // by settle's resets of the velocity
};

/// The critical step of deformed copies. Of all of them it takes as long as eighty steps, so they take turns.
struct LiveBound {
    double known = 0;                                       // s, the least of the last round and of this one
    double round = std::numeric_limits<double>::infinity(); // s, the least of this one so far
};

/// What steps, commands and cuts change, but for the cutter's part: a snapshot is a copy of both.
struct EngineState {
    Elements elements = {};
    Packing packing = {}; // of elements and nodes, for the step
    NodeArrays nodes = {};
    StepConstants constants = {};
    Tissue tissue = {};

    std::map<Index, Vec3> prescribed = {};        // displacement by row of Body::elements.nodes, m
    std::vector<std::vector<Index>> classes = {}; // [row of Body::elements.nodes] its simulation nodes
    std::vector<BladeWay> blades = {};            // in id order
    std::vector<GraspWay> grasps = {};            // in id order
    std::vector<Vec3f> swept = {};                // displacement up to which blades have swept [node]
    std::int64_t step = 0;                        // since creation
    std::int64_t clock_start = 0;                 // step at which time was `clock_before`
    double clock_before = 0;                      // s
    double carried = 0;                           // s asked for and not yet stepped

    Work work = {};
    double elastic_start = 0; // J
    Strain strain = {};
    LiveBound live_bound = {};

    std::vector<std::uint8_t> fixed = {}; // [node] 1: held or prescribed
    std::vector<float> copy_density = {}; // [copy] kg/m^3
    std::vector<std::uint8_t> weak = {};  // [copy] 1: it has left the trusted range, see stiffness.cpp
};

/// Everything that a simulation can go back to.
struct SavedEngine {
    EngineState state = {};
    std::shared_ptr<const CutterState> cutter = {};
};

struct Engine : EngineState {
    Model model = {};
    CutterPtr cutter = {};
    std::int64_t left = 1; // steps, this one included, over which grasps arrive
    Workers workers;
    std::vector<Recorded> record = {};
    std::size_t carried_out = 0;           // of record: commands before the last advance()
    std::vector<SavedEngine> strokes = {}; // what the last ones began with
    CutReport between = {};                // what commands cut since the last advance()

    std::vector<StepSums> sums = {};            // scratch of a step [chunk]
    std::vector<StrainCheck> strain_parts = {}; // scratch of a check [chunk]
    Delta delta = {};                           // scratch of a sweep
    std::vector<Index> moved = {};              // scratch of a sweep: old copies on other nodes

    explicit Engine(int threads) : workers(threads) {}
};

// simulation.cpp
Engine& engine_of(Simulation& simulation);

// create.cpp
Result<std::unique_ptr<Engine>> build_engine(Setup setup);

// conditions.cpp: who is held, prescribed and loaded
/// Masses, holds and loads of the listed nodes, from S.
void update_conditions(Engine& engine, std::span<const Index> touched);
void update_all_conditions(Engine& engine);

// materials.cpp
/// Bound, viscous times and step for these materials; an error where the step that was asked for is too long.
Result<Tissue> make_tissue(const Model& model, std::vector<Material> materials);
/// The critical time step at rest of the worst element, s.
double least_step_bound(const Model& model, std::span<const Material> materials);
/// Gives a region another material, and the simulation the step that follows.
Result<void> change_material(Engine& engine, const SetMaterial& set);

// quantities.cpp
/// The precomputed quantities of copies that a cut added, as Setup::cut.quantities says; their corners are
/// those of their parents, or of S.
void append_quantities(Engine& engine, std::span<const Delta::NewCopy> copies);

// stiffness.cpp
/// Moduli of the listed copies, after S has changed at their nodes.
void update_stiffness(Engine& engine, std::span<const Index> copies);
/// Of all copies, computed anew.
void update_all_stiffness(Engine& engine);
/// Weakens for good the light copies that the last forces found beyond the trusted range.
void weaken_strained(Engine& engine);
void count_weakened(Engine& engine); // into `strain`

// step.cpp
/// Forces of the present state, for node_update and settle.
void compute_forces(Engine& engine);
/// From these forces to the next state, in nodes.next_*.
StepSums update_nodes(Engine& engine);
/// One step of the motion; false: it diverged, and the state is the one before. After it, nodes.next_* hold
/// the state before.
bool step_motion(Engine& engine);

// watch.cpp
void check_strain_now(Engine& engine);
/// What is due in this step: all stretches, and the live bounds of a share of the copies.
void check_strain_if_due(Engine& engine);
/// The element that went wrong in a step that step_motion refused, and why, in words.
Index find_diverged_element(const Engine& engine, std::string& reason);

// warn.cpp
/// rho L / E of the softest material, s^2/m, L how far the body reaches from the box of what is held; 0 where
/// nothing is.
double measure_load_per_gravity(const Engine& engine);
/// What goes beyond what the method was seen to reach, in words; empty while all is well.
std::vector<std::string> find_warnings(const Engine& engine);

// blades.cpp
/// Sweeps the blades' next poses while the nodes move from where they were swept last to now; `left` counts
/// the sweeps, this one included, over which the remaining poses are spread.
void sweep_blades(Engine& engine, std::int64_t left, CutReport& report);
/// Sweeps a blade on in the direction of its last motion, longer than the body, until it has left the tissue,
/// which is held still. False: it has not moved.
bool cut_through(Engine& engine, const BladeWay& way, CutReport& report);
/// Sweeps one blade through tissue that is held still.
void sweep_still(Engine& engine, Index blade, const Edge& from, const Edge& to, CutReport& report);

// tools.cpp
bool is_grasped(const Engine& engine, Index node);
/// Free nodes whose material lies within `radius` of a point now.
std::vector<GraspedNode> find_grasped(const Engine& engine, const Vec3& at, double radius);
/// Puts prescribed nodes where they are told, and takes what is grasped one step further.
void move_told_nodes(Engine& engine);
/// After a cut: nodes are grasped, or not any more, by where their material is.
void update_grasps(Engine& engine, std::span<const Delta::NewNode> added);

// commands.cpp
Result<void> check_edge(const Edge& edge);
Result<void> apply_command(Engine& engine, const Command& command);

// history.cpp
SavedEngine save_engine(const Engine& engine);
void restore_engine(Engine& engine, const SavedEngine& saved);
/// Keeps the present state for Undo; the oldest go when there are many, or much.
void remember_stroke(Engine& engine);
/// False: there is no stroke to go back before.
bool undo_stroke(Engine& engine);

// settle.cpp
StepReport settle_engine(Engine& engine, double residual, double at_most);

} // namespace resect
