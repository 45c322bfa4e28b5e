#pragma once
// A recording drives the machine that it is of, without hardware: each step gives it what one cycle had, or does what was done beside the cycle, and
// compares what comes of it. Everything on one thread. Not real-time.
//
//     auto made = Replay::make(config, recording);     (errors as Machine::build has them, and those of the recording)
//     while (replay->step() == Replay::Step::more) {}
//     if (replay->difference()) ...
//
// Errors: replay.not_of_a_machine, replay.channels, replay.lost, replay.other_machine, replay.malformed, replay.folder.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "runtime/machine/machine.hpp"
#include "runtime/recording_file/recording.hpp"
#include "runtime/replay/difference.hpp"

namespace taktwerk::runtime {

class Replay {
public:
    using Made = std::variant<std::unique_ptr<Replay>, std::vector<Error>>;
    /// `recording` outlives the replay. Where the machine keeps something, it begins with what the recording has of it, in a folder of its own that
    /// goes with the replay.
    static Made make(MachineConfig config, RecordSource& recording);
    static Made make(MachineConfig config, const Recording& recording);
    ~Replay();
    Replay(const Replay&) = delete;
    Replay& operator=(const Replay&) = delete;

    enum class Step : std::uint8_t { more, ended, differs, malformed };
    /// A cycle, or what was done beside it. After `differs` it may go on, and tells the next difference.
    Step step();

    [[nodiscard]] Machine& machine() noexcept;
    /// The last step that differed.
    [[nodiscard]] const std::optional<ReplayDifference>& difference() const noexcept;
    [[nodiscard]] const std::optional<Error>& error() const noexcept;
    /// Cycles so far since the machine was up, and those before.
    [[nodiscard]] std::uint64_t cycles() const noexcept;
    [[nodiscard]] std::uint64_t cycles_before() const noexcept;
    /// Of the last cycle.
    [[nodiscard]] Instant now() const noexcept;
    /// What the recording calls 0.
    [[nodiscard]] Instant start() const noexcept;

private:
    struct Impl;
    explicit Replay(std::unique_ptr<Impl> impl);
    static Made make(MachineConfig config, RecordSource& recording, std::unique_ptr<RecordSource> owned);
    std::unique_ptr<Impl> impl_;
};

}  // namespace taktwerk::runtime
