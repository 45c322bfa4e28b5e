#include "apps/machine/log_entry.hpp"

#include <string_view>

#include <fmt/format.h>

#include "apps/terminal/json_text.hpp"

namespace taktwerk::apps {

std::string text_lines(const LogEntry& entry) {
    auto lines = fmt::format("{:9.3f} s  {:<9} {}\n", entry.at_s, entry.event, entry.text);
    const auto more = [&](std::string_view before, const std::string& text) {
        if (!text.empty()) lines += fmt::format("{:13}{:<9} {}{}\n", "", "", before, text);
    };
    more("-> ", entry.remedy);
    if (entry.alarm == nullptr) return lines;
    const auto& words = *entry.alarm;
    more("", words.chinese);
    more("why: ", words.cause);
    more("-> ", words.remedy.empty() ? words.remedy : fmt::format("{} ({})", words.remedy, words.reset));
    return lines;
}

std::string json_line(const LogEntry& entry) {
    auto line = fmt::format("{{\"t\":{:.3f},\"event\":{},\"text\":{}", entry.at_s, json_text(entry.event), json_text(entry.text));
    if (!entry.remedy.empty()) line += fmt::format(",\"remedy\":{}", json_text(entry.remedy));
    if (entry.alarm != nullptr) {
        const auto& words = *entry.alarm;
        line += fmt::format(",\"name\":{},\"chinese\":{},\"cause\":{},\"remedy\":{},\"reset\":{}", json_text(words.name),
                            json_text(words.chinese), json_text(words.cause), json_text(words.remedy), json_text(words.reset));
    }
    return line + "}\n";
}

}  // namespace taktwerk::apps
