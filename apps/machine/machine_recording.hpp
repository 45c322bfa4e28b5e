#pragma once
// `taktwerk run --record FILE`: everything that a machine takes from outside, and what it makes of it, into a file that `taktwerk replay` reads.

#include <memory>
#include <optional>
#include <string>

#include "config/reading/files_read.hpp"
#include "core/recorder.hpp"
#include "core/recording_file.hpp"
#include "core/result.hpp"
#include "core/time.hpp"
#include "runtime/machine/machine.hpp"

namespace taktwerk::apps {

/// What of this computer decides what a machine does: taktwerk itself, the files of the machine, its programs. Facts for the head of a recording.
/// `machine_file`: the path as it was given.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> facts_of(const std::string& machine_file, const config::FilesRead& files,
                                                                        const runtime::MachineConfig& config, bool simulated);

class MachineRecording {
public:
    /// Before the machine's first cycle; from here on it records. `facts`: facts_of(). `start`: machine time that people call 0.
    /// Errors: recording.write.
    [[nodiscard]] static Result<std::unique_ptr<MachineRecording>> create(const std::string& path, runtime::Machine& machine,
                                                                          std::vector<std::pair<std::string, std::string>> facts,
                                                                          Instant start, runtime::RecordedThreads threads);

    /// Writes what has come. Error recording.write, once: from then on records are taken and lost.
    Result<void> drain();
    /// The rest, and the end of the file. Gives the error of an earlier drain(), too.
    [[nodiscard]] Result<void> finish();
    /// Records that did not fit; from the first of them on the recording cannot be replayed.
    [[nodiscard]] std::uint64_t lost() const noexcept { return recorder_.dropped(); }

private:
    explicit MachineRecording(RecordingWriter writer);

    static constexpr std::size_t ring_bytes = std::size_t{32} << 20;  ///< of 200 axes at 1 ms some 8 s

    RecordingWriter writer_;
    Recorder recorder_;
    std::optional<Error> broken_;
};

}  // namespace taktwerk::apps
