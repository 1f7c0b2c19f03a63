// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "resect/commands.hpp"
#include "resect/reports.hpp"
#include "resect/setup.hpp"

namespace resect {

struct Engine; // model and state
struct SnapshotState;

/// The whole state of a simulation at one time, its record of commands included: a value, cheap to copy.
class Snapshot {
public:
    Snapshot() = default;
    bool empty() const { return state_ == nullptr; }
    /// For files and pickling, of this version on this kind of machine.
    std::string bytes() const;
    /// Refuses bytes that were damaged. Bytes that were forged on purpose are not noticed: load what you
    /// trust.
    static Result<Snapshot> from_bytes(std::string_view bytes);

private:
    friend class Simulation;
    explicit Snapshot(std::shared_ptr<const SnapshotState> state) : state_(std::move(state)) {}
    std::shared_ptr<const SnapshotState> state_ = {};
};

/// A body that moves and is cut. Move-only; one thread drives it; views live until its next non-const call.
class Simulation {
public:
    static Result<Simulation> create(Setup setup);
    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;
    ~Simulation();

    /// Refused whole, or recorded and in force from the next step.
    Result<void> apply(const Command& command);
    /// Steps over `seconds` (rounded to whole steps, the remainder is carried over), sweeping blades on their
    /// way. Stops early, at the last finite state, if the run diverges.
    StepReport advance(double seconds);
    /// Does what another simulation of the same setup recorded, at the same steps, and goes on to step
    /// `until`. An error where a command is refused, or a step diverges.
    Result<void> replay(std::span<const Recorded> commands, std::int64_t until);
    /// Steps until the out-of-balance force on the free nodes of held pieces, a mean over 500 steps, stays
    /// below `residual` of the applied force for 50 steps, for `at_most` simulated seconds; the clock then
    /// starts at zero again.
    StepReport settle(double residual = 1e-4, double at_most = 30);
    /// Places a blade, sweeps it while the tissue is held still, and lifts it.
    Result<CutReport> cut(Edge from, Edge to);

    /// Positions and normals of now; triangles with what changed since `since_revision`.
    Surface surface(std::uint64_t since_revision = 0);
    Nodes nodes() const;
    Copies copies() const;
    /// Today's material over the elements: export, or a start for other methods.
    Body material() const;
    std::vector<double> von_mises() const; // [copy] Cauchy, Pa
    /// [triangle of surface()] the row of copies() that it is a face of: brings fields of copies to the
    /// surface.
    std::vector<Index> surface_copies();
    std::span<const Piece> pieces();
    /// The commands applied; not what advance(), settle() and cut() were asked for.
    std::span<const Recorded> record() const;
    Index undoable_strokes() const; // how many Undo can go back
    /// As they are now, by region.
    std::span<const Material> materials() const;
    Vec3 gravity() const; // m/s^2, now
    Energies energies() const;
    TimeStep time_step() const;
    Strain strain() const;
    /// What goes beyond what the method was seen to reach, by load number or by the state at the last check:
    /// one sentence each, with the number and what to do. Empty while all is well.
    std::vector<std::string> warnings() const;
    double time() const;        // s
    std::int64_t steps() const; // since creation
    Snapshot snapshot() const;
    /// Goes back to a snapshot of this simulation, or of one that was created from the same setup; refused if
    /// it is of another. The hash is then that of the moment it was taken; strokes before cannot be undone
    /// any more.
    Result<void> restore(const Snapshot& snapshot);
    /// Of displacements, velocities, copies, material and step number; the same for any number of threads.
    std::uint64_t hash() const;

private:
    friend Engine& engine_of(Simulation& simulation); // for tests and fuzzing
    explicit Simulation(std::unique_ptr<Engine> engine);
    std::unique_ptr<Engine> engine_;
};

/// The instruction set that the element kernels run on here: avx512, avx2 or sse2. All give the same bits.
const char* instruction_set();
/// Forces one for the whole process, before any simulation steps. False: this processor has no such.
bool choose_instruction_set(const std::string& name);

} // namespace resect
