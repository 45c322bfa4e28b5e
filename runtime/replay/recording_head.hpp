#pragma once
// What stands in the head of a recording of a machine besides its channels, and the files that it began with. Not real-time.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/time.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/machine_config.hpp"
#include "runtime/recording_file/recording.hpp"

namespace taktwerk::runtime {

/// Facts by name; those of apps/ (taktwerk, binary, file:..., program:...) are compared as they stand.
namespace head_fact {
inline constexpr std::string_view machine = "machine", cycle = "cycle_ns", start = "start_ns", retain = "retain", threads = "threads",
                                  one_thread = "one", mode = "start_mode";
inline constexpr std::string_view file_prefix = "file:", program_prefix = "program:", binary = "binary", version = "taktwerk";
}  // namespace head_fact

/// Facts of the machine itself, and the channels. `start`: machine time that people call 0. `threads`: as it is given to Machine::record().
[[nodiscard]] RecordingInfo recording_info(const MachineConfig& config, Instant start, RecordedThreads threads);
/// nullptr: not there.
[[nodiscard]] const std::string* find_fact(const RecordingInfo& info, std::string_view name) noexcept;

/// A file of what was kept over a time without power, as the machine found it: u16 length of its name, name, bytes. Before the first tick.
inline constexpr RecordChannel start_file_channel = 20;

/// Behind the name of one that was there and could not be read: an alarm depends on it. It has no bytes.
inline constexpr std::string_view unreadable_file = ".unreadable";

struct StartFile {
    std::string name;
    std::string bytes;
};
/// What was kept, as the machine finds it at its start: before its first cycle. Empty where nothing is kept.
[[nodiscard]] std::vector<StartFile> start_files(const MachineConfig& config);
/// As a record of start_file_channel. Errors: recording.start_file, where it is too long for a recording.
[[nodiscard]] std::vector<std::byte> start_file_record(const StartFile& file);

/// One line for each fact that is another one there than here: "program 'cell' is another one: crc32:... then, crc32:... now".
[[nodiscard]] std::vector<std::string> other_facts(const RecordingInfo& then, const RecordingInfo& now);

}  // namespace taktwerk::runtime
