#pragma once
// The switch that makes a test of every machine test: with TAKTWERK_REPLAY_ALL=1 what a rig's machine does is recorded, and when the rig goes the
// recording drives the same machine again, which has to do the same, byte by byte. `./dev nightly` runs all machine tests so, `./dev test` a sample.

#include <cstdlib>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "runtime/replay/recording_head.hpp"
#include "runtime/replay/replay.hpp"
#include "runtime/run/virtual_runner.hpp"

namespace taktwerk::runtime::testing {

/// What a machine takes and makes, in memory. Declared before the machine, so that it outlives it.
class RecordedInMemory {
public:
    /// Before the machine's first cycle. `runner`: takes away after each cycle; nullptr: the caller does, by drain().
    void watch(Machine& machine, VirtualRunner* runner, Instant start, RecordedThreads threads = RecordedThreads::one) {
        config_ = machine.config();
        recording_ = {};
        full_ = false;
        recording_.info = recording_info(config_, start, threads);
        for (const auto& file : start_files(config_)) {
            const auto record = start_file_record(file);
            keep({start_file_channel, start, record});
        }
        recorder_.emplace(std::size_t{16} << 20, Recorder::Policy::drop_newest);
        machine.record(*recorder_, threads);
        if (runner != nullptr) runner->drain = [this] { drain(); };
    }
    [[nodiscard]] bool watches() const { return recorder_.has_value(); }
    void drain() {
        recorder_->drain([this](const RecordView& record) { keep(record); });
    }
    /// Up to now.
    [[nodiscard]] Recording& recording() {
        drain();
        recording_.end = full_ ? RecordingEnd::limit : RecordingEnd::whole;
        recording_.lost = full_ ? 0 : recorder_->dropped();
        return recording_;
    }
    [[nodiscard]] const MachineConfig& config() const { return config_; }

private:
    void keep(const RecordView& record) {
        if (full_ || recording_.bytes.size() > most) {
            full_ = true;  // the beginning is compared all the same
            return;
        }
        recording_.add(record);
    }

    static constexpr std::size_t most = std::size_t{512} << 20;
    MachineConfig config_;
    Recording recording_;
    bool full_ = false;
    std::optional<Recorder> recorder_;
};

/// What came of a replay.
struct Replayed {
    std::uint64_t cycles = 0;  ///< since the machine was up
    std::optional<ReplayDifference> difference;
    std::vector<std::string> errors;
    [[nodiscard]] bool identical() const { return !difference && errors.empty(); }
    [[nodiscard]] std::string text() const {
        std::string all = difference ? difference->text(Instant{}) : std::string{};
        for (const auto& error : errors) all += error + "\n";
        return all;
    }
};

inline Replayed replay_all(const MachineConfig& config, const Recording& recording) {
    Replayed out;
    auto made = Replay::make(config, recording);
    if (auto* errors = std::get_if<1>(&made)) {
        for (const auto& error : *errors) out.errors.push_back(error.code + ": " + error.text());
        return out;
    }
    auto& replay = *std::get<0>(made);
    auto step = Replay::Step::more;
    while (step == Replay::Step::more) step = replay.step();
    out.cycles = replay.cycles();
    if (step == Replay::Step::differs) out.difference = replay.difference();
    if (step == Replay::Step::malformed) out.errors.push_back(replay.error()->code + ": " + replay.error()->text());
    return out;
}

/// A member of a rig.
class ReplayCheck {
public:
    ReplayCheck() = default;
    ReplayCheck(const ReplayCheck&) = delete;
    ReplayCheck& operator=(const ReplayCheck&) = delete;
    ~ReplayCheck() {
        if (!recorded_.watches() || left_out_) return;
        const auto replayed = replay_all(recorded_.config(), recorded_.recording());
        EXPECT_TRUE(replayed.identical()) << "a replay of this machine does something else: " << replayed.text();
    }

    [[nodiscard]] static bool wanted() {
        const char* set = std::getenv("TAKTWERK_REPLAY_ALL");
        return set != nullptr && std::string(set) == "1";
    }
    /// As RecordedInMemory::watch(), where it is wanted.
    void watch(Machine& machine, VirtualRunner* runner, Instant start) {
        if (wanted()) recorded_.watch(machine, runner, start);
    }
    /// A test in which something of its program reaches out of the machine, so that a second one cannot do the same.
    void leave_out() { left_out_ = true; }

private:
    RecordedInMemory recorded_;
    bool left_out_ = false;
};

}  // namespace taktwerk::runtime::testing
