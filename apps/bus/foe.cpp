#include "apps/bus/foe.hpp"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>

#include <fmt/format.h>

#include "apps/terminal/duration_option.hpp"

namespace taktwerk::apps {

void add_foe_options(CLI::App& sub, FoeOptions& options) {
    sub.add_option("--password", options.password, "a number, 0x and hexadecimal or decimal; default: 0, for none");
    add_duration(sub, "--timeout", options.patience_s, "until the slave must answer each packet; default: 20s");
}

Result<std::uint32_t> password_of(const std::string& text) {
    std::uint32_t value = 0;
    if (text.empty()) return value;
    const bool hexadecimal = text.starts_with("0x") || text.starts_with("0X");
    const char* begin = text.data() + (hexadecimal ? 2 : 0);
    const char* end = text.data() + text.size();
    const auto [last, problem] = std::from_chars(begin, end, value, hexadecimal ? 16 : 10);
    if (problem == std::errc{} && last == end && begin != end) return value;
    return Error{"usage.number", "--password", "'" + text + "' is no password: in FoE it is a number of 32 bits",
                 "write it as 1234 or 0x12345678"};
}

Result<void> check_slave_file_name(const std::string& name, const char* option) {
    if (name.empty())
        return Error{"foe.name", option, "is empty: no slave has a file without a name", "give the name that the slave's maker writes"};
    const auto control = std::find_if(name.begin(), name.end(), [](char c) {
        const auto code = static_cast<unsigned char>(c);
        return code < 0x20 || code == 0x7F;
    });
    if (control == name.end()) return {};
    return Error{"foe.name", option,
                 fmt::format("has the control character {:02X}h at place {}", static_cast<unsigned>(static_cast<unsigned char>(*control)),
                             control - name.begin() + 1),
                 "give the name as the slave's maker prints it (in a shell, $'...' and a pasted line end make such characters)"};
}

std::string progress_text(const ecat::FoeProgress& progress) {
    constexpr double kib = 1024.0;
    std::string text = fmt::format("{:.1f} KiB", static_cast<double>(progress.bytes) / kib);
    if (progress.of) {
        const std::size_t percent = *progress.of == 0 ? 100 : 100 * progress.bytes / *progress.of;
        text = fmt::format("{:.1f} of {:.1f} KiB, {} %", static_cast<double>(progress.bytes) / kib, static_cast<double>(*progress.of) / kib,
                           percent);
    }
    if (!progress.busy) return text;
    text += progress.entire == 0 ? fmt::format("; the slave is busy: {} %", progress.done)
                                 : fmt::format("; the slave is busy: {} of {}", progress.done, progress.entire);
    if (!progress.words.empty()) text += fmt::format(" '{}'", progress.words);
    return text;
}

FoeProgressLine::FoeProgressLine(const BusOptions& options) : silent_(options.json), terminal_(::isatty(STDERR_FILENO) != 0) {}

void FoeProgressLine::show(const ecat::FoeProgress& progress) {
    if (silent_) return;
    if (terminal_) {
        fmt::print(stderr, "\r\x1b[K{}", progress_text(progress));
        std::fflush(stderr);
        shown_ = true;
        return;
    }
    if (!progress.of || *progress.of == 0) return;
    const int tenths = static_cast<int>(10 * progress.bytes / *progress.of);
    if (tenths > tenths_ && !progress.busy) fmt::print(stderr, "{}\n", progress_text(progress));
    if (!progress.busy) tenths_ = std::max(tenths_, tenths);
}

void FoeProgressLine::end() {
    if (shown_) fmt::print(stderr, "\n");
    shown_ = false;
}

ecat::FoeSettings foe_settings(const FoeOptions& options, FoeProgressLine& line) {
    ecat::FoeSettings settings;
    if (options.patience_s > 0)
        settings.patience.answer = std::chrono::duration_cast<Duration>(std::chrono::duration<double>{options.patience_s});
    settings.progress = [&line](const ecat::FoeProgress& progress) { line.show(progress); };
    return settings;
}

Result<void> offers_files(const ecat::BusSlave& slave, const BusOptions& options) {
    const auto& sii = slave.found.sii;
    const bool silent = sii.mailbox_protocols == 0 && slave.has_mailbox();
    if (silent || options.force || (sii.mailbox_protocols & ecat::sii_protocol::foe) != 0) return {};
    return Error{"foe.not_offered", slave.subject, "its EEPROM says that it has no FoE: it takes no files",
                 "check that this is the slave you mean; with --force it is asked all the same"};
}

}  // namespace taktwerk::apps
