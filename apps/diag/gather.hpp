#pragma once
// What goes into the file, in memory: each part with its size, and why a part is not there. Not real-time; asks the running machine nothing that
// changes anything.

#include <string>
#include <vector>

#include "hmi_bridge/socket/client.hpp"

namespace taktwerk::apps {

struct DiagPart {
    std::string path;   ///< in the archive, "machine/cell.yaml"
    std::string about;  ///< in words
    std::string bytes;
    std::vector<std::string> masked{};  ///< what was taken out of it
};

struct Gathered {
    std::string machine;  ///< name; empty: none was found
    std::vector<DiagPart> parts;
    std::vector<std::string> missing;  ///< what is not in it, and why
};

/// Most of all recordings together, newest first.
inline constexpr std::size_t most_recordings = 5;
inline constexpr std::size_t most_recording_bytes = 64u << 20;
/// Of a text that grows (a log), its end.
inline constexpr std::size_t most_text_bytes = 4u << 20;

/// A part whose secrets are masked; then a longer text loses its beginning. Where its path is taken it gets a number.
void add_text(Gathered& all, std::string path, std::string about, std::string text);

/// What a reason quotes may be a secret as well. Last of all.
void mask_reasons(Gathered& all);

/// State, layout, statistics, histograms, bus, alarms, log, recordings of a machine that runs. False: it does not answer, and is not asked again.
bool gather_running(Gathered& all, hmi::Client& client);
/// The machine file and the files that it names, but for programs; where the machine does not run its recordings and alarm history too.
void gather_files(Gathered& all, const std::string& machine_file, bool runs);
/// Versions, what the doctor finds (without measuring), kernel, interrupts, the journal of its unit.
void gather_host(Gathered& all, const std::string& interface);

}  // namespace taktwerk::apps
