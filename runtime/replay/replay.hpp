#pragma once
// A recording drives the machine that it is of, without hardware: each step gives it what one cycle had, or does what was done beside the cycle, and
// compares what comes of it. Everything on one thread. Not real-time.
//
//     auto made = Replay::make(config, recording);     (errors as Machine::build has them, and those of the recording)
//     while (replay->step() == Replay::Step::more) {}
//     if (replay->difference()) ...
//
// Errors: replay.not_of_a_machine, replay.channels, replay.lost, replay.several_threads, replay.other_machine, replay.malformed, replay.folder.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/recording_file.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/machine/replayed_inbox.hpp"
#include "runtime/replay/difference.hpp"
#include "runtime/replay/replay_transport.hpp"
#include "runtime/replay/stand_ins.hpp"

namespace taktwerk::runtime {

class Replay {
public:
    /// `recording` outlives the replay. Where the machine keeps something, it begins with what the recording has of it, in a folder of its own that
    /// goes with the replay.
    static std::variant<std::unique_ptr<Replay>, std::vector<Error>> make(MachineConfig config, const Recording& recording);
    ~Replay();
    Replay(const Replay&) = delete;
    Replay& operator=(const Replay&) = delete;

    enum class Step : std::uint8_t { more, ended, differs, malformed };
    /// A cycle, or what was done beside it. After `differs` it may go on, and tells the next difference.
    Step step();

    [[nodiscard]] Machine& machine() noexcept { return *machine_; }
    /// The last step that differed.
    [[nodiscard]] const std::optional<ReplayDifference>& difference() const noexcept { return difference_; }
    [[nodiscard]] const std::optional<Error>& error() const noexcept { return error_; }
    /// Cycles so far since the machine was up, and those before.
    [[nodiscard]] std::uint64_t cycles() const noexcept { return cycles_; }
    [[nodiscard]] std::uint64_t cycles_before() const noexcept { return cycles_before_; }
    /// Of the last cycle.
    [[nodiscard]] Instant now() const noexcept { return now_; }
    /// What the recording calls 0.
    [[nodiscard]] Instant start() const noexcept { return start_; }

private:
    struct Folder;
    Replay(const Recording& recording, const WireRecord& wire, const MachineConfig& config);

    [[nodiscard]] bool begins_a_step(std::size_t record) const noexcept;
    /// Everything of [first, last) that comes from outside goes in.
    [[nodiscard]] bool put(std::size_t first, std::size_t last);
    [[nodiscard]] bool put(const RecordView& record);
    [[nodiscard]] bool perform(const RecordView& record);
    void compare(std::size_t first, std::size_t last);

    const Recording& recording_;
    std::unique_ptr<Folder> folder_;
    ReplayTransport transport_;
    StandIns stand_ins_;
    Recorder again_;
    std::unique_ptr<Machine> machine_;
    std::size_t next_ = 0;
    bool armed_ = false;
    std::uint64_t cycles_ = 0, cycles_before_ = 0;
    Instant now_{}, start_{};
    Outcome then_, now_made_;  // as of the last step
    std::optional<ReplayDifference> difference_;
    std::optional<Error> error_;
};

}  // namespace taktwerk::runtime
