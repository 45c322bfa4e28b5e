#include "apps/machine/monitor_groups.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "apps/terminal/terminal_text.hpp"
#include "hmi_bridge/socket/json_number.hpp"

namespace taktwerk::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char *bold = "1", *dim = "2", *red = "1;31", *green = "32", *yellow = "33";
constexpr std::array<const char*, 6> components{"X", "Y", "Z", "RX", "RY", "RZ"};

class Group {
public:
    Group(const Json& group, const ScreenSize& size) : group_(group), size_(size) {}

    void put(std::vector<std::string>& out, bool details) const {
        out.push_back(cut(head(), size_.columns));
        if (!details) {
            put_error(out);
            return put_refusal(out);
        }
        if (tool_known()) {
            out.push_back(line("set    " + pose("tool_set") + fmt::format("   {:.1f} {}/s", number("tool_speed"), text("unit"))));
            out.push_back(line("actual " + pose("tool_actual") + fmt::format("   {:.1f} {}/s", number("tool_actual_speed"), text("unit"))));
        }
        for (const auto& frame : group_.value("frames", Json::array())) out.push_back(line(seen_from(frame)));
        if (const auto doing = what_it_does(); !doing.empty()) out.push_back(line(doing));
        if (const auto limits = limits_used(); !limits.empty()) out.push_back(line(limits));
        put_error(out);
        put_refusal(out);
    }

private:
    [[nodiscard]] std::string text(const char* key) const { return group_.at(key).get<std::string>(); }
    [[nodiscard]] double number(const char* key) const { return hmi::number_of(group_.at(key)); }
    [[nodiscard]] bool flag(const char* key) const { return group_.at(key).get<bool>(); }
    /// Of a way of one axis: its own.
    [[nodiscard]] std::string path_unit() const { return group_.value("path_unit", text("unit")); }
    /// Its measure is the norm of what several axes go: no length, and what is left of it says nothing to anybody. Its share does.
    [[nodiscard]] bool of_axes() const { return path_unit() == "u" && text("unit") != "u"; }
    [[nodiscard]] bool tool_known() const { return flag("tool_known"); }
    [[nodiscard]] std::string paint(const char* code, const std::string& what) const {
        return size_.colours ? fmt::format("\033[{}m{}\033[0m", code, what) : what;
    }
    [[nodiscard]] std::string line(const std::string& what) const { return paint(dim, cut("          " + what, size_.columns)); }

    [[nodiscard]] std::string head() const {
        const auto state = text("state");
        const char* look = state == "GroupErrorStop"                                                   ? red
                           : state == "GroupDisabled"                                                  ? dim
                           : state == "GroupStopping" || state == "GroupHoming" || flag("interrupted") ? yellow
                                                                                                       : green;
        auto out = fmt::format("{} {}", paint(bold, left(" " + text("name"), 9)), paint(look, left(state, 18)));
        out += flag("powered") ? "on" : " -";
        if (flag("interrupted")) out += flag("held") ? "   INTERRUPTED by a person" : "   interrupted by its program";
        if (state != "GroupMoving" && state != "GroupStopping") return out;
        return out +
               fmt::format("   {:.1f} {}/s{}{}", number("path_velocity"), path_unit(), of_axes() ? " of its axes together" : "", limited());
    }

    [[nodiscard]] std::string limited() const {
        const auto limiter = text("limiter");
        if (limiter == "axis_limit") return ", held back by axis " + text("limiting_axis");
        if (limiter == "setup_velocity") return ", held at the set-up velocity of the tool";
        if (limiter == "override_factor") return ", held by the override";
        if (limiter == "command") return ", as commanded";
        // At rest nothing limits a velocity; who waits for it has to see why it does not go.
        if (number("override") * number("operators_override") == 0) return ", held by the override";
        return "";
    }

    [[nodiscard]] std::string pose(const char* key) const { return pose(group_.at(key)); }
    [[nodiscard]] std::string pose(const Json& place) const {
        std::string out;
        for (std::size_t i = 0; i < components.size(); ++i) {
            const double value = hmi::number_of(place[i]);
            out += fmt::format("{}{} {:.3f}{}", i == 0 ? "" : "  ", components[i], std::abs(value) < 0.0005 ? 0.0 : value,
                               i == 2   ? " " + text("unit")
                               : i == 5 ? " deg"
                                        : "");
        }
        return out;
    }

    /// The actual place in a frame that is not the machine's.
    [[nodiscard]] std::string seen_from(const Json& frame) const {
        const auto axis = frame.at("axis").get<std::string>();
        return left(frame.at("frame").get<std::string>(), 7) + (tool_known() ? pose(frame.at("tool_actual")) : std::string("not known")) +
               (axis.empty() ? std::string{} : "   with " + axis);
    }
    /// The frame that moves and that it goes with; also with no command.
    [[nodiscard]] std::string goes_with() const {
        const auto kind = group_.value("track", std::string("none"));
        if (kind == "none") return {};
        return fmt::format("with {} {}, {}", kind, group_.value("track_axis", std::string{}),
                           group_.value("track_in_sync", false)
                               ? std::string("in step")
                               : fmt::format("{:.1f} {} behind", hmi::number_of(group_.value("track_lag", Json(0))), text("unit")));
    }

    [[nodiscard]] std::string what_it_does() const {
        std::string out;
        if (const auto command = text("command"); !command.empty()) {
            const auto block = text("block");
            out = fmt::format("{}{}{}  {:.0f} %", command, block.empty() ? "" : " ", block, 100 * number("progress"));
            if (const double to_go = number("distance_to_go"); to_go > 0 && !of_axes())
                out += fmt::format(", {:.1f} {} to go", to_go, path_unit());
            if (const double left = number("remaining_s"); left > 0) out += fmt::format(", {:.1f} s", left);
        }
        if (const int queued = group_.at("queued").get<int>(); queued > 0) out += fmt::format("{}{} wait", out.empty() ? "" : ", ", queued);
        if (const auto with = goes_with(); !with.empty()) out += (out.empty() ? "" : "   ") + with;
        if (const double factor = number("override") * number("operators_override"); factor < 1)
            out += fmt::format("{}override {:.0f} %", out.empty() ? "" : "   ", 100 * factor);
        return out;
    }

    /// Of each axis what it uses most of.
    [[nodiscard]] std::string limits_used() const {
        std::string out;
        bool any = false;
        for (const auto& member : group_.at("members")) {
            const char* of = "v";
            double most = hmi::number_of(member.at("velocity_use"));
            for (const auto& [key, letter] : {std::pair{"acceleration_use", "a"}, std::pair{"jerk_use", "j"}})
                if (const double use = hmi::number_of(member.at(key)); use > most) {
                    most = use;
                    of = letter;
                }
            any = any || most > 0;
            out += fmt::format("{}{} {:.0f} %{}", out.empty() ? "limits " : "  ", member.at("axis").get<std::string>(), 100 * most,
                               most > 0 ? fmt::format(" {}", of) : "");
        }
        return any ? out : std::string{};
    }

    void put_error(std::vector<std::string>& out) const {
        if (text("state") != "GroupErrorStop" && group_.at("error").get<int>() == 0) return;
        const auto name = group_.value("error_name", std::string("error ") + std::to_string(group_.at("error").get<int>()));
        const auto words = group_.value("error_text", std::string{});
        const auto said = words.empty() ? name : words.starts_with(name) ? words : fmt::format("{}: {}", name, words);
        out.push_back(paint(red, cut("   " + said, size_.columns)));
        if (const auto cause = group_.value("error_cause", std::string{}); !cause.empty())
            out.push_back(cut("   why: " + cause, size_.columns));
        if (const auto remedy = group_.value("error_remedy", std::string{}); !remedy.empty())
            out.push_back(cut(fmt::format("   -> {}", remedy), size_.columns));
    }

    /// What it has refused of its program, last.
    void put_refusal(std::vector<std::string>& out) const {
        const auto refusal = group_.find("refusal");
        if (refusal == group_.end()) return;
        const auto of = [&](const char* key) { return refusal->value(key, std::string{}); };
        const auto block = of("block");
        out.push_back(paint(
            red, cut(fmt::format("   refused {}{}{}: {} ({})", of("command"), block.empty() ? "" : " ", block, of("text"), of("error")),
                     size_.columns)));
        if (const auto where = of("where"); !where.empty()) {
            // A narrow screen must not lose the place behind the room.
            for (std::size_t begin = 0; begin < where.size();) {
                auto end = where.find("; ", begin);
                for (auto next = end; next != std::string::npos && next - begin + 10 < static_cast<std::size_t>(size_.columns);
                     next = where.find("; ", next + 1))
                    end = next;
                if (where.size() - begin + 10 < static_cast<std::size_t>(size_.columns)) end = std::string::npos;
                const auto part = where.substr(begin, end == std::string::npos ? end : end - begin);
                out.push_back(cut(fmt::format("   {} {}", begin == 0 ? "where:" : "      ", part), size_.columns));
                begin = end == std::string::npos ? where.size() : end + 2;
            }
        }
        if (const auto remedy = of("remedy"); !remedy.empty()) out.push_back(cut(fmt::format("   -> {}", remedy), size_.columns));
    }

    const Json& group_;
    const ScreenSize& size_;
};

}  // namespace

std::vector<std::string> monitor_groups(const Json& state, const ScreenSize& size, bool details) {
    std::vector<std::string> out;
    const auto groups = state.find("groups");
    if (groups == state.end()) return out;
    for (const auto& group : *groups) Group(group, size).put(out, details);
    return out;
}

}  // namespace taktwerk::apps
