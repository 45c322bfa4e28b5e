// The language of faults: one line, words with spaces between.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "core/nearest_name.hpp"
#include "ecat/sim/faults.hpp"
#include "ecat/wire/frame.hpp"
#include "ecat/wire/sdo.hpp"

namespace taktwerk::ecat::sim {

namespace {

using K = FaultKind;

/// Of the longest frame; a frame that is shorter flips that bit modulo its own length.
constexpr std::uint32_t largest_bit = max_frame_size * 8 - 1;

constexpr std::array commands{
    FaultCommand{K::unplug, "unplug", "SLAVE",
                 "pulls the cable that leads to SLAVE; `unplug master`: the one at the master, `unplug ring`: at its second interface"},
    FaultCommand{K::plug, "plug", "SLAVE", "plugs it in again"},
    FaultCommand{K::power_off, "power-off", "SLAVE", "no power: silent, and what is behind it is gone"},
    FaultCommand{K::power_on, "power-on", "SLAVE", "power again: everything at its reset values"},
    FaultCommand{K::power_cycle, "power-cycle", "SLAVE [TIME]", "off and on again after TIME (500ms)"},
    FaultCommand{K::drop, "drop", "N", "the next N frames are lost before any slave sees them"},
    FaultCommand{K::drop_answers, "drop-answers", "N", "the slaves act on the next N frames, the answers are lost"},
    FaultCommand{K::duplicate, "duplicate", "N", "the next N answers come twice"},
    FaultCommand{K::delay, "delay", "N TIME", "the next N answers come TIME later"},
    FaultCommand{K::reorder, "reorder", "N", "each of the next N answers comes after the one that follows it"},
    FaultCommand{K::corrupt, "corrupt", "N [BIT]", "one bit of the next N answers flips, behind a valid checksum"},
    FaultCommand{K::noise, "noise", "SLAVE N", "the next N frames are damaged on the cable before SLAVE: it counts errors, they are lost"},
    FaultCommand{K::stick_mailbox, "stick-mailbox", "SLAVE on|off", "its mailbox neither takes nor answers anything"},
    FaultCommand{K::wrong_length, "wrong-length", "SLAVE N", "its next N mailbox answers claim a length that is not theirs"},
    FaultCommand{K::refuse, "refuse", "SLAVE STATE CODE|off", "it refuses PREOP, SAFEOP or OP with this AL status code"},
    FaultCommand{K::abort, "abort", "SLAVE INDEX:SUB CODE|off", "it aborts every SDO to this object with this code"},
    FaultCommand{K::hang, "hang", "SLAVE on|off", "its firmware hangs; its controller goes on by itself"},
    FaultCommand{K::drift, "drift", "SLAVE PPM", "its quartz runs fast by PPM from now on (negative: slow)"},
    FaultCommand{K::clock_step, "clock-step", "SLAVE TIME", "its clock jumps by TIME (negative: back)"},
    FaultCommand{K::forget_address, "forget-address", "SLAVE", "its station address (0010h) becomes 0"},
};

std::vector<std::string_view> words_of(std::string_view text) {
    std::vector<std::string_view> words;
    for (std::size_t at = 0; at < text.size();) {
        const auto begin = text.find_first_not_of(" \t\r\n", at);
        if (begin == std::string_view::npos) break;
        const auto end = std::min(text.find_first_of(" \t\r\n", begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        at = end;
    }
    return words;
}

/// Decimal, or hexadecimal after 0x.
std::optional<std::uint32_t> number(std::string_view text, std::uint32_t largest) {
    int base = 10;
    if (text.starts_with("0x") || text.starts_with("0X")) {
        base = 16;
        text.remove_prefix(2);
    }
    std::uint32_t value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    if (problem != std::errc{} || end != text.data() + text.size() || value > largest) return std::nullopt;
    return value;
}

std::optional<double> decimal(std::string_view text, std::string_view& rest) {
    double value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc{} || !std::isfinite(value)) return std::nullopt;
    rest = text.substr(static_cast<std::size_t>(end - text.data()));
    return value;
}

/// "5ms", "-200ns", "1.5s".
std::optional<Duration> time_span(std::string_view text) {
    std::string_view unit;
    const auto value = decimal(text, unit);
    if (!value) return std::nullopt;
    constexpr std::array<std::pair<std::string_view, double>, 4> units{{{"ns", 1.0}, {"us", 1e3}, {"ms", 1e6}, {"s", 1e9}}};
    constexpr double longest_ns = 3600e9;
    for (const auto& [name, ns] : units)
        if (unit == name && std::abs(*value * ns) <= longest_ns) return Duration{static_cast<std::int64_t>(std::llround(*value * ns))};
    return std::nullopt;
}

std::optional<EsmState> state_named(std::string_view text) {
    std::string lower{text};
    std::transform(lower.begin(), lower.end(), lower.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    if (lower == "preop") return EsmState::preop;
    if (lower == "safeop") return EsmState::safeop;
    if (lower == "op") return EsmState::op;
    return std::nullopt;
}

/// Reads the arguments of one command one after the other; a wrong one ends it.
class Arguments {
public:
    Arguments(const FaultCommand& command, std::span<const std::string_view> words) noexcept : command_(command), words_(words) {}

    void slave(Fault& fault) {
        if (const auto word = take("SLAVE")) fault.slave = std::string{*word};
    }
    void count(Fault& fault) { assign(fault.count, "N", number(take("N").value_or(""), 1'000'000)); }
    /// Nothing comes before it was asked for.
    void time(Fault& fault) {
        auto value = time_span(take("TIME").value_or(""));
        if (value && *value < Duration::zero()) value.reset();
        assign(fault.time, "TIME (as 5ms)", value);
    }
    void step(Fault& fault) { assign(fault.time, "TIME (as 5ms or -5ms)", time_span(take("TIME").value_or(""))); }
    void bit(Fault& fault) {
        assign(fault.bit, fmt::format("a bit of a frame (0 to {})", largest_bit), number(take("BIT").value_or(""), largest_bit));
    }
    void on_off(Fault& fault) {
        const auto word = take("on or off").value_or("");
        if (word == "on" || word == "off") fault.on = word == "on";
        else wrong("on or off", word);
    }
    void state(Fault& fault) { assign(fault.state, "STATE (PREOP, SAFEOP or OP)", state_named(take("STATE").value_or(""))); }
    void object(Fault& fault) {
        const auto word = take("INDEX:SUB").value_or("");
        const auto colon = word.find(':');
        const auto hex = [](std::string_view text, std::uint32_t largest) { return number("0x" + std::string{text}, largest); };
        // Objects are hexadecimal everywhere: 6060:00, or with 0x before it.
        const auto part = [](std::string_view text) { return text.starts_with("0x") ? text.substr(2) : text; };
        const auto index = hex(part(word.substr(0, colon)), 0xFFFF);
        const auto sub = colon == std::string_view::npos ? std::optional<std::uint32_t>{0} : hex(part(word.substr(colon + 1)), 0xFF);
        if (!index || !sub) return wrong("INDEX:SUB (as 6060:00)", word);
        fault.index = static_cast<std::uint16_t>(*index);
        fault.sub = static_cast<std::uint8_t>(*sub);
    }
    template <class Code>
    void code_or_off(Fault& fault, Code& code) {
        const auto word = take("CODE").value_or("");
        if (word == "off") {
            fault.on = false;
            return;
        }
        const auto value = number(word, std::numeric_limits<Code>::max());
        if (!value || *value == 0) return wrong("CODE (as 0x001B) or off", word);
        code = static_cast<Code>(*value);
    }
    void ppm(Fault& fault) {
        const auto word = take("PPM").value_or("");
        std::string_view rest;
        const auto value = decimal(word, rest);
        if (!value || (!rest.empty() && rest != "ppm") || std::abs(*value) > 1000) return wrong("PPM (-1000 to 1000)", word);
        fault.drift_ppm = *value;
    }
    [[nodiscard]] bool more() const noexcept { return next_ < words_.size(); }
    [[nodiscard]] std::optional<Error> problem() {
        if (!problem_ && more()) problem_ = fmt::format("'{}' is one word too many", words_[next_]);
        if (!problem_) return std::nullopt;
        return Error{"fault.arguments", std::string{command_.word}, *problem_,
                     fmt::format("write: {} {}", command_.word, command_.arguments)};
    }

private:
    std::optional<std::string_view> take(std::string_view what) {
        if (problem_) return std::nullopt;
        if (!more()) {
            problem_ = fmt::format("{} is missing", what);
            return std::nullopt;
        }
        return words_[next_++];
    }
    void wrong(std::string_view wanted, std::string_view got) {
        if (!problem_) problem_ = fmt::format("'{}' is not {}", got, wanted);
    }
    template <class T, class U>
    void assign(T& member, std::string_view wanted, const std::optional<U>& value) {
        if (value) member = *value;
        else if (next_ > 0) wrong(wanted, words_[next_ - 1]);
    }

    const FaultCommand& command_;
    std::span<const std::string_view> words_;
    std::size_t next_ = 0;
    std::optional<std::string> problem_;
};

void read(Arguments& in, Fault& fault) {
    constexpr Duration usual_power_cycle = std::chrono::milliseconds{500};
    switch (fault.kind) {
        case K::unplug:
        case K::plug:
        case K::power_off:
        case K::power_on:
        case K::forget_address: in.slave(fault); break;
        case K::power_cycle:
            in.slave(fault);
            fault.time = usual_power_cycle;
            if (in.more()) in.time(fault);
            break;
        case K::drop:
        case K::drop_answers:
        case K::duplicate:
        case K::reorder: in.count(fault); break;
        case K::delay: in.count(fault), in.time(fault); break;
        case K::corrupt:
            in.count(fault);
            if (in.more()) in.bit(fault);
            break;
        case K::noise:
        case K::wrong_length: in.slave(fault), in.count(fault); break;
        case K::stick_mailbox:
        case K::hang: in.slave(fault), in.on_off(fault); break;
        case K::refuse: in.slave(fault), in.state(fault), in.code_or_off(fault, fault.al_code); break;
        case K::abort: in.slave(fault), in.object(fault), in.code_or_off(fault, fault.abort_code); break;
        case K::drift: in.slave(fault), in.ppm(fault); break;
        case K::clock_step: in.slave(fault), in.step(fault); break;
    }
}

}  // namespace

std::span<const FaultCommand> fault_commands() noexcept { return commands; }

Result<Fault> parse_fault(std::string_view text) {
    const auto all = words_of(text);
    std::span words{all};
    Fault fault;
    if (!words.empty() && words.front() == "after") {
        const auto time = words.size() > 1 ? time_span(words[1]) : std::nullopt;
        if (!time || *time < Duration::zero() || words.size() < 3)
            return Error{"fault.arguments", "after", "a time and a command are missing", "write: after 2s unplug y_drive"};
        fault.after = *time;
        words = words.subspan(2);
    }
    if (words.empty()) return Error{"fault.unknown", "", "the line is empty", "`help` lists the commands"};
    const auto command = std::find_if(commands.begin(), commands.end(), [&](const FaultCommand& c) { return c.word == words.front(); });
    if (command == commands.end()) {
        std::vector<std::string> known{"after"};
        for (const auto& c : commands) known.emplace_back(c.word);
        const auto near = nearest_name(words.front(), known);
        return Error{"fault.unknown", std::string{words.front()}, "there is no such command",
                     near.empty() ? "`help` lists them" : fmt::format("did you mean '{}'?", near)};
    }
    fault.kind = command->kind;
    Arguments arguments{*command, words.subspan(1)};
    read(arguments, fault);
    if (auto problem = arguments.problem()) return *problem;
    return fault;
}

}  // namespace taktwerk::ecat::sim
