#pragma once
// Everything that a machine takes from outside, and what it makes of it, for `taktwerk replay`: into a file (`taktwerk run --record FILE`), and into
// the memory of the run, of which a file is made behind an alarm.

#include <memory>
#include <optional>
#include <string>

#include "config/reading/files_read.hpp"
#include "core/recorder.hpp"
#include "core/result.hpp"
#include "core/time.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/recording_file/recording_file.hpp"
#include "runtime/run_memory/run_memory.hpp"

namespace taktwerk::apps {

/// What of this computer decides what a machine does: taktwerk itself, the files of the machine, its programs. Facts for the head of a recording.
/// `machine_file`: the path as it was given.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> facts_of(const std::string& machine_file, const config::FilesRead& files,
                                                                        const runtime::MachineConfig& config, bool simulated);

/// The file of --record, and how large it may get.
struct RecordedFile {
    std::string path;
    runtime::RecordingRoom room;
};

class MachineRecording {
public:
    /// The run in memory, kept behind alarms.
    struct Memory {
        runtime::RunMemory::Place place;
        runtime::RunMemory::Room room;
    };
    struct Wanted {
        RecordedFile file{};  ///< no path: none
        std::optional<Memory> memory;
    };
    /// As the machine's `recording` says; `start`, `epoch`: as RunMemory::Place has them. None where the bus' scripts, which take memory from the heap,
    /// would come onto the thread of a cycle that has no time for it: in real time below 1 ms, where the machine requires real time, or where
    /// groups of axes have paths planned.
    [[nodiscard]] static std::optional<Memory> memory_of(const runtime::MachineConfig& config, Instant start, Duration epoch,
                                                         runtime::RecordedThreads threads);

    /// Before the machine's first cycle; from here on it records. `facts`: facts_of(). `start`: machine time that people call 0.
    /// Errors: recording.write, recording.directory.
    [[nodiscard]] static Result<std::unique_ptr<MachineRecording>> create(const Wanted& wanted, runtime::Machine& machine,
                                                                          std::vector<std::pair<std::string, std::string>> facts,
                                                                          Instant start, runtime::RecordedThreads threads);

    /// Takes what has come, about a second of the machine at a time. Gives what went wrong with the file, once: from then on it gets no more, and
    /// the machine runs on.
    std::optional<Error> drain();
    /// The rest, and the end of the file. Gives the error of an earlier drain(), too. Before RunMemory::finish().
    [[nodiscard]] Result<void> finish();
    /// Records that did not fit; from the first of them on the recording cannot be replayed.
    [[nodiscard]] std::uint64_t lost() const noexcept { return recorder_.dropped(); }
    /// nullptr: not wanted.
    [[nodiscard]] runtime::RunMemory* memory() noexcept { return memory_.get(); }

private:
    MachineRecording();
    void take(const RecordView& record);
    void take_block();

    static constexpr std::size_t ring_bytes = std::size_t{32} << 20;  ///< of 200 axes at 1 ms some 8 s
    static constexpr Duration block_time = std::chrono::seconds{1};   ///< what a process that is killed loses at most

    Recorder recorder_;
    runtime::RecordPacker packer_;
    Instant block_began_{}, last_{};
    std::optional<runtime::RecordingWriter> writer_;
    std::unique_ptr<runtime::RunMemory> memory_;
    std::optional<Error> broken_;
};

}  // namespace taktwerk::apps
