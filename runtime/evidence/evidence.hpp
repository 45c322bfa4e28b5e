#pragma once
// Writes what was on the bus around each alarm that stops something.
//
//     auto evidence = Evidence::open(machine, epoch);     machine.bus().set_tap(&ecat::FrameMemory::tap, &(*evidence)->frames());
//     service side: look(snapshot) again and again;   a thread that may wait for a disk: write_due(now) again and again, finish() last

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/alarm.hpp"
#include "core/result.hpp"
#include "core/time.hpp"
#include "ecat/recording/frame_memory.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/new_alarms.hpp"

namespace taktwerk::runtime {

class Evidence {
public:
    /// What a file shows after its first alarm.
    static constexpr Duration after = std::chrono::seconds{1};
    /// From one file to the next, at least: a machine that trips again and again fills no disk. What comes meanwhile stands in the next file.
    static constexpr Duration apart = std::chrono::seconds{10};

    /// Of the machine's `evidence`; the folder is made. `epoch`: calendar time at machine time 0. `machine` outlives it. Errors:
    /// evidence.directory.
    [[nodiscard]] static Result<std::unique_ptr<Evidence>> open(const Machine& machine, Duration epoch);

    [[nodiscard]] ecat::FrameMemory& frames() noexcept { return frames_; }

    /// Service side; waits for nothing.
    void look(const Snapshot& snapshot);

    struct File {
        std::string path;  ///< empty: nothing was due
        std::uint64_t frames = 0;
        Duration covered{};
        std::size_t alarms = 0;
    };
    /// The writer's thread. Errors capture.write, evidence.write: that file is lost, later ones are tried.
    [[nodiscard]] Result<File> write_due(Instant now);
    /// After the last cycle: what has not been written yet.
    [[nodiscard]] Result<File> finish();

private:
    struct Noticed {
        AlarmFact fact;
        Instant since{};
        std::string name, text;
    };
    Evidence(const Machine& machine, Duration epoch);
    /// True: a file will show it.
    bool notice(const AlarmFact& fact, Reaction reaction, Instant since);
    [[nodiscard]] std::vector<Noticed> due(Instant now);
    [[nodiscard]] Result<File> write(const Recorder& moments, const std::vector<Noticed>& alarms);
    [[nodiscard]] std::string path_of(const Noticed& alarm) const;

    const Machine& machine_;
    const EvidenceConfig& config_;
    Duration epoch_;
    ecat::FrameMemory frames_;

    // service side
    NewAlarms alarms_;

    std::mutex mutex_;
    std::vector<Noticed> noticed_;  // handed over

    // writer
    std::vector<Noticed> waiting_;
    Instant last_written_{};
    bool has_written_ = false;
};

}  // namespace taktwerk::runtime
