#include "apps/machine/journal.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdint>

#include <fmt/format.h>

namespace taktwerk::apps {
namespace {

struct Kind {
    std::string_view event, id;
    char priority;
};
/// Drawn once, never changed: whoever filters by them relies on it.
constexpr std::string_view id_alarm = "1e77b007946aa3eef9be4a60fef6cd0d", id_other = "d5bf0d8c021f5cdb7fc83068e1e111ea";
constexpr std::array<Kind, 8> kinds{{{"gone", "4bee33c8135f2906c14cf736d165e9a1", '5'},
                                     {"E-STOP", "034d1af409ac56d90852af08dbf40892", '4'},
                                     {"STUCK", "f2680978d9b0342de6d8cab211e645fe", '2'},
                                     {"machine", "ead0c89216f27feb5b7cfcbfc88089e3", '5'},
                                     {"stop", "a8d567f289db5427c7aaf03f61eff77b", '5'},
                                     {"program", "18600f06592663cb202f3886faf17e1d", '5'},
                                     {"mode", "eb94c3f0b7eab2ba068cfdccf71d19ac", '6'},
                                     {"recording", "eaf89f92abe318a0bf8d0e0da3e15034", '5'}}};

/// The alarm's reaction says how grave it is.
char priority_of(const runtime::AlarmText& words) {
    if (words.reaction == "none") return '6';
    return words.reaction == "warn" ? '4' : '3';
}

void put(std::string& out, std::string_view name, std::string_view value) {
    if (value.empty()) return;
    out += name;
    if (value.find('\n') == std::string_view::npos) {
        out += '=';
    } else {  // with its size, little-endian, in front
        out += '\n';
        for (unsigned i = 0; i < 8; ++i) out += static_cast<char>(static_cast<std::uint64_t>(value.size()) >> (8 * i) & 0xFF);
    }
    out += value;
    out += '\n';
}

constexpr std::string_view of_axis = "axis ";

}  // namespace

std::string journal_fields(const std::string& machine, const LogEntry& entry) {
    std::string_view id = entry.alarm != nullptr ? id_alarm : id_other;
    char priority = entry.alarm != nullptr ? priority_of(*entry.alarm) : '6';
    for (const auto& kind : kinds)
        if (entry.alarm == nullptr && kind.event == entry.event) id = kind.id, priority = kind.priority;
    std::string out;
    put(out, "MESSAGE", fmt::format("{}: {}", entry.event, entry.text));
    put(out, "PRIORITY", std::string_view(&priority, 1));
    put(out, "MESSAGE_ID", id);
    put(out, "SYSLOG_IDENTIFIER", "taktwerk");
    put(out, "TAKTWERK_MACHINE", machine);
    put(out, "TAKTWERK_EVENT", entry.event);
    put(out, "TAKTWERK_TIME", fmt::format("{:.3f}", entry.at_s));
    put(out, "TAKTWERK_REMEDY", entry.remedy);
    std::string_view source = entry.event;
    if (entry.alarm != nullptr) {
        const auto& words = *entry.alarm;
        source = words.source;
        put(out, "TAKTWERK_ALARM", words.name);
        put(out, "TAKTWERK_SOURCE", words.source);
        put(out, "TAKTWERK_REACTION", words.reaction);
        put(out, "TAKTWERK_CAUSE", words.cause);
        put(out, "TAKTWERK_REMEDY", words.remedy);
        put(out, "TAKTWERK_RESET", words.reset);
        put(out, "TAKTWERK_CHINESE", words.chinese);
        put(out, "TAKTWERK_MANUAL", words.manual);
    }
    if (source.starts_with(of_axis)) put(out, "TAKTWERK_AXIS", source.substr(of_axis.size()));
    return out;
}

bool Journal::take(const LogEntry& entry) const { return out_.send(journal_fields(machine_, entry)); }

bool output_is_journal(const char* journal_stream) noexcept {
    struct stat output {};
    if (journal_stream == nullptr || ::fstat(STDOUT_FILENO, &output) != 0) return false;
    char own[64];
    const auto end = fmt::format_to_n(own, sizeof own - 1, "{}:{}", output.st_dev, output.st_ino);
    return std::string_view(own, static_cast<std::size_t>(end.size)) == journal_stream;
}

}  // namespace taktwerk::apps
