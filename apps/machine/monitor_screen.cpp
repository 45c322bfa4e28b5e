#include "apps/machine/monitor_screen.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "apps/machine/monitor_groups.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/terminal_text.hpp"
#include "hmi_bridge/socket/json_number.hpp"

namespace taktwerk::apps {
namespace {

using Json = nlohmann::ordered_json;
using Lines = std::vector<std::string>;

namespace colour {
constexpr const char *bold = "1", *dim = "2", *bar = "7", *red = "1;31", *alert = "1;97;41", *green = "32", *yellow = "33",
                     *simulated = "30;43";
}

class Screen {
public:
    Screen(const Json& state, const Json& layout, const ScreenSize& size) : state_(state), layout_(layout), size_(size) {}

    Lines lines() const {
        const auto head = heading();
        const auto points = io();
        const auto work = programs();
        const auto told = events();
        for (const bool details : {true, false}) {
            const auto table = joined({axes(details), monitor_groups(state_, size_, details)});
            Lines out;
            for (const std::size_t causes : {every, std::size_t{1}}) {  // the newest alarm keeps its cause longest
                out = joined({head, table, alarms(every, causes), told, work, points});
                if (fits(out)) return out;
            }
            if (details) continue;
            // The alarms get what the axes leave, at least one of them; programs and I/O what is left then.
            const auto taken = head.size() + table.size() + 2;
            const auto remaining = size_.rows > taken + 1 ? size_.rows - taken - 1 : 0;  // 1: the line that says there are more
            out = joined({head, table, alarms(std::max<std::size_t>(remaining / lines_an_alarm, 1), 0), told, work, points});
            if (out.size() > size_.rows) {
                out.resize(size_.rows);
                out.back() = paint(colour::dim, cut("… the terminal is too small for the rest", size_.columns));
            }
            return out;
        }
        return {};
    }

private:
    static constexpr std::size_t lines_an_alarm = 3, every = 1000, shown_events = 3;
    bool fits(const Lines& lines) const { return size_.rows == 0 || lines.size() <= size_.rows; }

    static Lines joined(const std::vector<Lines>& parts) {
        Lines out;
        for (const auto& part : parts) {
            if (part.empty()) continue;
            if (!out.empty()) out.emplace_back();
            out.insert(out.end(), part.begin(), part.end());
        }
        return out;
    }

    std::string paint(const char* code, const std::string& text) const {
        return size_.colours ? fmt::format("\033[{}m{}\033[0m", code, text) : text;
    }

    static double us(const Json& ns) { return hmi::number_of(ns) / 1e3; }

    Lines heading() const {
        const bool stop = state_.at("emergency_stop").get<bool>(), simulated = state_.at("simulated").get<bool>();
        const double seconds = state_.at("cycle").get<double>() * layout_.at("cycle_ns").get<double>() * 1e-9;
        std::string text = fmt::format(" {}   mode {}   {}", state_.at("machine").get<std::string>(), state_.at("mode").get<std::string>(),
                                       state_.at("phase").get<std::string>());
        const std::string flags = fmt::format("{}{}", stop ? " EMERGENCY STOP " : "", simulated ? " SIMULATED " : "");
        const std::string time = fmt::format(" {:.1f} s ", seconds);
        constexpr std::size_t paper = 100;  // columns of the bar where there is no terminal
        const auto width = size_.colours ? size_.columns : std::min(size_.columns, paper);
        const auto room = width - std::min(width, columns(flags) + columns(time));
        Lines out;
        out.push_back(paint(colour::bar, left(text, room)) + (stop ? paint(colour::alert, " EMERGENCY STOP ") : "") +
                      (simulated ? paint(colour::simulated, " SIMULATED ") : "") + paint(colour::bar, time));
        const auto& s = state_.at("statistics");
        const auto& bus = state_.at("bus");
        const auto line = fmt::format(" cycle {:g} ms   late {:.0f} us (max {:.0f})   computing {:.0f} us (max {:.0f})   missed {}",
                                      layout_.at("cycle_ns").get<double>() / 1e6, us(s.at("lateness_ns")), us(s.at("lateness_max_ns")),
                                      us(s.at("compute_ns")), us(s.at("compute_max_ns")), s.at("missed_ticks").get<std::uint64_t>());
        out.push_back(cut(line, size_.columns));
        out.push_back(cut(fmt::format(" bus {}{}   {}, {} not fresh   frames lost {}, late {}   working counter errors {}",
                                      bus.at("phase").get<std::string>(), ring_text(bus), count_text(state_.at("slaves").size(), "slave"),
                                      stale_slaves(), bus.at("frames_lost").get<std::uint64_t>(),
                                      bus.at("frames_late").get<std::uint64_t>(), bus.at("working_counter_errors").get<std::uint64_t>()),
                          size_.columns));
        return out;
    }

    /// Where there are two interfaces: ", ring closed", or how many slaves each of them reaches.
    static std::string ring_text(const Json& bus) {
        const auto shape = bus.value("ring", std::string("none"));
        if (shape == "none" || shape == "unknown") return {};
        if (shape == "closed") return ", ring closed";
        return fmt::format(", ring broken ({} + {})", bus.value("ring_before_break", 0), bus.value("ring_behind_break", 0));
    }

    int stale_slaves() const {
        int count = 0;
        for (const auto& slave : state_.at("slaves")) count += slave.at("fresh").get<bool>() ? 0 : 1;
        return count;
    }

    Lines axes(bool details) const {
        Lines out;
        if (state_.at("axes").empty()) return out;
        out.push_back(paint(colour::dim, fmt::format("{} {} {} {} {} {} {}", left(" axis", 9), left("state", 18), "on hm", right("set", 11),
                                                     right("actual", 11), right("velocity", 10), right("following", 10))));
        for (const auto& axis : state_.at("axes")) {
            const auto state = axis.at("state").get<std::string>();
            const char* look = state == "ErrorStop"                       ? colour::red
                               : state == "Disabled"                      ? colour::dim
                               : state == "Stopping" || state == "Homing" ? colour::yellow
                                                                          : colour::green;
            out.push_back(fmt::format("{} {} {} {} {} {} {} {}", paint(colour::bold, left(" " + axis.at("name").get<std::string>(), 9)),
                                      paint(look, left(state, 18)), axis.at("powered").get<bool>() ? "on" : " -",
                                      axis.at("homed").get<bool>() ? "hm" : " -", right(number(axis.at("set_position")), 11),
                                      right(number(axis.at("actual_position")), 11), right(number(axis.at("actual_velocity")), 10),
                                      right(number(axis.at("following_error")), 10)));
            if (details) out.push_back(paint(colour::dim, detail(axis)));
        }
        return out;
    }

    std::string detail(const Json& axis) const {
        std::string text =
            fmt::format("          {}  drive {}", axis.at("unit").get<std::string>(), axis.at("drive_state").get<std::string>());
        if (const int error = axis.at("drive_error").get<int>()) text += fmt::format(" error {:04X}h", error);
        text += fmt::format("  owner {}", axis.at("owner").get<std::string>());
        const auto block = axis.at("block").get<std::string>(), command = axis.at("command").get<std::string>();
        if (!block.empty() || !command.empty())
            text += fmt::format(" ({}{}{})", command, block.empty() || command.empty() ? "" : " ", block);
        if (axis.value("held_by_stop", false)) text += "  HELD BY MC_Stop";
        const auto limiter = axis.value("velocity_limiter", std::string{});
        for (const auto& [word, shown] :
             {std::pair{"axis_limit", "at the axis' limit"}, std::pair{"manual_speed", "held to manual speed"},
              std::pair{"override_factor", "held by the override"}, std::pair{"software_limit", "brakes for a software limit"}})
            if (limiter == word) text += fmt::format("  {}", shown);
        if (const double factor = axis.value("operators_override", 1.0); factor < 1) text += fmt::format("  override {:g} %", 100 * factor);
        if (axis.at("disabled").get<bool>()) text += "  left out";
        else if (const auto presence = axis.value("presence", std::string{}); presence == "absent" || presence == "joining")
            text += fmt::format("  {} {}", axis.at("group").get<std::string>(), presence == "joining" ? "is joining" : "is not connected");
        else if (!axis.at("online").get<bool>()) text += "  offline";
        if (axis.at("simulated").get<bool>() && !state_.at("simulated").get<bool>()) text += "  SIMULATED";
        if (axis.at("negative_limit_switch").get<bool>()) text += "  limit-";
        if (axis.at("positive_limit_switch").get<bool>()) text += "  limit+";
        if (axis.at("home_switch").get<bool>()) text += "  home switch";
        return cut(text, size_.columns);
    }

    /// The newest `most`, the newest `causes` of them with why they came.
    Lines alarms(std::size_t most, std::size_t causes) const {
        Lines out;
        const auto& list = state_.at("alarms");
        std::size_t shown = 0;
        for (auto it = list.rbegin(); it != list.rend(); ++it) {  // newest first
            const auto& alarm = *it;
            if (shown++ == most) {
                out.push_back(paint(colour::red, fmt::format(" … and {} alarms more", list.size() - most)));
                break;
            }
            const bool standing = alarm.at("standing").get<bool>(), acknowledged = alarm.at("acknowledged").get<bool>();
            const auto times = alarm.at("count").get<unsigned>();
            auto text = fmt::format(" {} {}: {}",
                                    standing       ? "!"
                                    : acknowledged ? " "
                                                   : "?",
                                    alarm.at("source").get<std::string>(), alarm.at("english").get<std::string>());
            if (times > 1) text += fmt::format(" ({} times)", times);
            out.push_back(paint(standing ? colour::red : colour::yellow, cut(text, size_.columns)));
            if (const auto chinese = alarm.at("chinese").get<std::string>(); !chinese.empty())
                out.push_back(cut("   " + chinese, size_.columns));
            if (const auto cause = alarm.at("cause").get<std::string>(); !cause.empty() && shown <= causes)
                out.push_back(cut("   why: " + cause, size_.columns));
            const auto reset = alarm.at("reset").get<std::string>();
            if (const auto remedy = alarm.at("remedy").get<std::string>(); !remedy.empty())
                out.push_back(cut(reset.empty() ? "   -> " + remedy : fmt::format("   -> {} ({})", remedy, reset), size_.columns));
        }
        return out;
    }

    /// The newest commands that were refused or aborted.
    static std::string whose(const Json& event) {
        const auto group = event.value("group", std::string{});
        return group.empty() ? "axis " + event.at("axis").get<std::string>() : "group " + group;
    }

    Lines events() const {
        Lines out;
        const auto found = state_.find("events");
        if (found == state_.end()) return out;
        const auto first = found->size() > shown_events ? found->size() - shown_events : 0;
        for (auto i = found->size(); i-- > first;) {
            const auto& event = (*found)[i];
            const auto times = event.at("times").get<unsigned>();
            const double ago = (hmi::number_of(state_.at("time_ns")) - hmi::number_of(event.at("time_ns"))) * 1e-9;
            out.push_back(cut(fmt::format(" {} s ago  {}: {}{}", fmt::format("{:.0f}", ago), whose(event),
                                          event.at("english").get<std::string>(), times > 1 ? fmt::format(" ({} times)", times) : ""),
                              size_.columns));
            if (i + 1 == found->size()) out.push_back(cut("   -> " + event.at("remedy").get<std::string>(), size_.columns));
        }
        return out;
    }

    Lines programs() const {
        Lines out;
        for (const auto& program : state_.at("programs")) {
            const auto name = program.at("name").get<std::string>();
            std::vector<std::string> words;
            for (const auto& v : state_.at("variables"))
                if (v.at("program") == name) words.push_back(value("", v));
            for (const auto& p : state_.at("parameters"))
                if (p.at("program") == name) words.push_back(value("set ", p));
            wrap(out, fmt::format(" program {} {}", name, program.at("state").get<std::string>()), words);
        }
        return out;
    }

    Lines io() const {
        Lines out;
        for (const auto& [key, title] : {std::pair{"inputs", " inputs "}, std::pair{"outputs", " outputs"}}) {
            std::vector<std::string> words;
            const bool inputs = std::string_view(key) == "inputs";
            const auto units = state_.value(inputs ? "input_units" : "output_units", Json::object());
            for (const auto& [name, value] : state_.at(key).items())
                words.push_back(point(name, value, units) + (inputs && is_doubtful(name) ? "?" : "") +
                                (is_forced(name, inputs ? "input" : "output") ? " FORCED" : ""));
            if (!words.empty()) wrap(out, title, words);
        }
        return out;
    }

    static std::string point(const std::string& name, const Json& value, const Json& units) {
        const auto unit = units.find(name);
        if (unit == units.end()) return fmt::format("{}={}", name, value.get<std::int64_t>());
        return fmt::format("{}={:.5g} {}", name, hmi::number_of(value), unit->get<std::string>());
    }
    /// Its slave is not exchanged, its terminal reports an error, or it is beyond its limits.
    bool is_doubtful(const std::string& input) const {
        const auto names = state_.value("doubtful_inputs", Json::array());
        return std::find(names.begin(), names.end(), Json(input)) != names.end();
    }

    bool is_forced(const std::string& name, std::string_view direction) const {
        for (const auto& force : state_.value("forced", Json::array()))
            if (force.at("point") == name && force.at("direction") == direction) return true;
        return false;
    }

    static std::string value(const char* before, const Json& variable) {
        const auto unit = variable.at("unit").get<std::string>();
        return fmt::format("{}{}={:g}{}{}", before, variable.at("name").get<std::string>(), hmi::number_of(variable.at("value")),
                           unit.empty() ? "" : " ", unit);
    }

    /// Words after a title, on as many lines as it takes.
    void wrap(Lines& out, const std::string& title, const std::vector<std::string>& words) const {
        std::string line = title;
        for (const auto& word : words) {
            if (columns(line) + 2 + columns(word) > size_.columns && columns(line) > columns(title)) {
                out.push_back(line);
                line.assign(columns(title), ' ');
            }
            line += "  " + word;
        }
        out.push_back(cut(line, size_.columns));
    }

    /// Three decimals, fewer for large numbers: always within the column.
    static std::string number(const Json& value) {
        const double x = hmi::number_of(value);
        const double size = std::abs(x);
        return size < 1e6 ? fmt::format("{:.3f}", x == 0 ? 0.0 : x) : fmt::format("{:.4g}", x);
    }

    const Json& state_;
    const Json& layout_;
    ScreenSize size_;
};

}  // namespace

std::vector<std::string> monitor_screen(const Json& state, const Json& layout, const ScreenSize& size) {
    return Screen(state, layout, size).lines();
}

}  // namespace taktwerk::apps
