#include "apps/machine/measure_text.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <vector>

#include <fmt/format.h>

#include "hmi_bridge/socket/json_number.hpp"

namespace taktwerk::apps {
namespace {

using Json = nlohmann::ordered_json;

double number(const Json& json, const char* key) { return json.contains(key) ? hmi::number_of(json.at(key)) : std::nan(""); }

/// "overshoot       0.0123 mm  +- 0.0004"
std::string line(std::string_view what, const Json& estimate, double factor, std::string_view unit) {
    if (estimate.is_null()) return fmt::format("  {:<28} not to be seen in these samples\n", what);
    const double value = number(estimate, "value") * factor, deviation = number(estimate, "deviation") * factor;
    return fmt::format("  {:<28} {:>12.6g} {}{}\n", what, value, unit, deviation > 0 ? fmt::format("  +- {:.2g}", deviation) : "");
}

std::string moves(const Json& r, const std::string& unit) {
    std::string text;
    text += line("overshoot", r.at("overshoot"), 1, unit);
    text += line(fmt::format("settling to +-{:g} {}", number(r, "window"), unit), r.at("settling_time_s"), 1e3, "ms");
    if (!r.at("all_settled").get<bool>()) text += "  (not every move settled while it was watched)\n";
    text += line("rise time, 10 to 90 %", r.at("rise_time_s"), 1e3, "ms");
    text += line("largest following error", r.at("largest_error"), 1, unit);
    text += line("error at constant velocity", r.at("error_at_velocity"), 1, unit);
    if (!r.at("lag_s").is_null()) text += fmt::format("  {:<28} {:>12.6g} ms\n", "that is a lag of", number(r, "lag_s") * 1e3);
    text += line("velocity ripple", r.at("velocity_ripple"), 1, unit + "/s");
    return text;
}

std::string line_of(std::string_view what, double value, std::string_view unit) {
    return fmt::format("  {:<28} {:>12.6g} {}\n", what, value, unit);
}

std::string friction(const Json& r, const std::string& unit) {
    std::string text;
    text += line("gravity", r.at("gravity"), 100, "% of rated torque");
    text += line("Coulomb friction", r.at("coulomb"), 100, "%");
    text += line("  in positive direction", r.at("coulomb_positive"), 100, "%");
    text += line("  in negative direction", r.at("coulomb_negative"), 100, "%");
    text += line("viscous friction", r.at("viscous"), 100, "% per " + unit + "/s");
    text += line("breakaway, positive", r.at("breakaway_positive"), 100, "%");
    text += line("breakaway, negative", r.at("breakaway_negative"), 100, "%");
    const auto& curve = r.at("curves").at(0);
    text += fmt::format("  {:>12} {:>10} {:>9}\n", unit + "/s", "torque %", "ripple %");
    for (std::size_t i = 0; i < curve.at("velocity").size(); ++i)
        text += fmt::format("  {:>12.5g} {:>10.3f} {:>9.3f}\n", hmi::number_of(curve.at("velocity")[i]),
                            100 * hmi::number_of(curve.at("torque")[i]), 100 * hmi::number_of(curve.at("ripple")[i]));
    return text;
}

std::string following(const Json& r, const std::string& unit) {
    std::string text;
    text += line_of("following error, rms", number(r, "rms_error"), unit);
    text += line("of it by velocity, a lag of", r.at("lag_s"), 1e3, "ms");
    text += line("by acceleration", r.at("per_acceleration_s2"), 1e6, fmt::format("{unit} per 1e6 {unit}/s2", fmt::arg("unit", unit)));
    text += line("by the direction (friction)", r.at("per_direction"), 1, unit);
    text += line_of("what they leave, rms", number(r, "rms_left"), unit);
    const auto& t = r.at("torque");
    text += line("torque: gravity", t.at("gravity"), 100, "% of rated torque");
    text += line("torque: Coulomb friction", t.at("coulomb"), 100, "%");
    text += line("torque: viscous friction", t.at("viscous"), 100, "% per " + unit + "/s");
    text += line("torque: inertia", t.at("inertia"), 100, "% per " + unit + "/s2");
    return text;
}

std::string margin(std::string_view what, const Json& m, std::string_view unit, bool frequency_too) {
    if (m.is_null()) return fmt::format("  {:<28} not inside this sweep\n", what);
    return fmt::format("  {:<28} {:>12.4g} {}{}\n", what, number(m, "value"), unit,
                       frequency_too ? fmt::format(" at {:.4g} Hz", number(m, "frequency_hz")) : "");
}

std::string sweep(const Json& r, const std::string& unit) {
    std::string text;
    text += margin("bandwidth (-3 dB)", r.at("bandwidth_hz"), "Hz", false);
    text += margin("bandwidth (-90 degrees)", r.at("phase_bandwidth_hz"), "Hz", false);
    text += margin("resonance", r.at("resonance_db"), "dB", true);
    text += margin("valley (what swings behind)", r.at("notch_db"), "dB", true);
    text += margin("phase margin", r.at("phase_margin_deg"), "degrees", true);
    text += margin("gain margin", r.at("gain_margin_db"), "dB", true);
    text += "  the open loop is T / (1 - T): its margins hold only without feed-forward in the drive and here\n";
    const auto& c = r.at("curves").at(0);
    text +=
        fmt::format("  {:>9} {:>12} {:>9} {:>9} {:>9} {:>9} {:>8}\n", "Hz", "+- " + unit, "dB", "degrees", "open dB", "degrees", "quality");
    for (std::size_t i = 0; i < c.at("frequency_hz").size(); ++i) {
        const auto cell = [&](const char* key) {
            const auto& value = c.at(key)[i];
            return value.is_null() ? std::string("-") : fmt::format("{:.2f}", hmi::number_of(value));
        };
        text += fmt::format("  {:>9.3f} {:>12.4g} {:>9} {:>9} {:>9} {:>9} {:>8.3f}{}\n", hmi::number_of(c.at("frequency_hz")[i]),
                            hmi::number_of(c.at("amplitude")[i]), cell("gain_db"), cell("phase_deg"), cell("open_gain_db"),
                            cell("open_phase_deg"), hmi::number_of(c.at("quality")[i]),
                            c.at("usable")[i].get<bool>() ? "" : "  too little to see");
    }
    return text;
}

std::string cogging(const Json& r, const std::string& unit) {
    std::string text;
    text += line_of("torque, highest to lowest", 100 * number(r, "peak_to_peak"), "% of rated torque");
    text += line_of("period", number(r, "period"), fmt::format("{}, {} of them seen", unit, r.at("periods").get<std::uint64_t>()));
    const auto& waves = r.at("curves").at(0);
    text += fmt::format("  {:>8} {:>10} {:>14} {:>14}\n", "in it", "torque %", "error " + unit, unit + "/s");
    std::vector<std::size_t> order(waves.at("order").size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return hmi::number_of(waves.at("torque")[a]) > hmi::number_of(waves.at("torque")[b]); });
    for (std::size_t i = 0; i < std::min<std::size_t>(5, order.size()); ++i) {
        const double torque = hmi::number_of(waves.at("torque")[order[i]]);
        if (torque < number(r, "noise")) break;
        text += fmt::format("  {:>8} {:>10.3f} {:>14.4g} {:>14.4g}\n", waves.at("order")[order[i]].get<int>(), 100 * torque,
                            hmi::number_of(waves.at("error")[order[i]]), hmi::number_of(waves.at("velocity")[order[i]]));
    }
    return text;
}

std::string proposals(const Json& r) {
    if (!r.contains("proposals") || r.at("proposals").empty()) return "";
    std::string text = "  proposed for the machine file (nothing is written by itself):\n";
    for (const auto& p : r.at("proposals"))
        text += fmt::format("    {}: {:.5g}{}    # +- {:.2g}\n", p.at("key").get<std::string>(), number(p, "value"),
                            p.at("unit").get<std::string>().empty() ? "" : " " + p.at("unit").get<std::string>(), number(p, "deviation"));
    return text;
}

std::string doubt_text(const std::string& doubt) {
    if (doubt == "no_samples") return "it ended before there was anything to measure";
    if (doubt == "ended_early") return "it ended early: only what was driven is told";
    if (doubt == "lost_samples") return "samples are missing: the computer was too slow, do not trust the numbers";
    if (doubt == "nothing_to_see") return "the answer is smaller than what is resolved: give a larger distance, velocity or acceleration";
    if (doubt == "saturated") return "the torque was at its limit: give a lower velocity or acceleration";
    if (doubt == "too_little_motion") return "the causes cannot be told apart: give a larger distance, velocity or acceleration";
    return doubt;
}

std::string end_text(const std::string& end) {
    if (end == "stopped") return "let go or stopped before its end";
    if (end == "lease") return "its lease ran out before a renewal came";
    if (end == "alarm") return "an alarm of the axis ended it: see `taktwerk monitor`";
    if (end == "refused") return "the axis did not take a set-point";
    return end;
}

}  // namespace

std::string plan_text(const Json& plan) {
    const auto unit = plan.at("unit").get<std::string>();
    std::string text = fmt::format("{}: moves between {:.6g} and {:.6g} {unit} at up to {:.6g} {unit}/s and {:.6g} {unit}/s2",
                                   plan.at("kind").get<std::string>(), number(plan, "lowest"), number(plan, "highest"),
                                   number(plan, "velocity"), number(plan, "acceleration"), fmt::arg("unit", unit));
    if (plan.contains("from_hz")) text += fmt::format(", {:.4g} to {:.4g} Hz", number(plan, "from_hz"), number(plan, "to_hz"));
    return text + fmt::format(", {:.1f} s", number(plan, "duration_s"));
}

std::string result_text(const Json& r) {
    const auto unit = r.at("unit").get<std::string>();
    const auto kind = r.at("kind").get<std::string>();
    std::string text = fmt::format("{}: {} samples, dead time {:.3g} ms\n", r.at("axis").get<std::string>(),
                                   r.at("samples").get<std::uint64_t>(), number(r, "dead_time_s") * 1e3);
    if (kind == "step" || kind == "ramp") text += moves(r, unit);
    if (kind == "friction" && r.contains("curves")) text += friction(r, unit);
    if (kind == "following") text += following(r, unit);
    if (kind == "sweep") text += sweep(r, unit);
    if (kind == "cogging") text += cogging(r, unit);
    text += proposals(r);
    if (const auto doubt = r.value("doubt", std::string{}); !doubt.empty()) text += "  " + doubt_text(doubt) + "\n";
    if (const auto end = r.at("end").get<std::string>(); end != "done") text += "  " + end_text(end) + "\n";
    return text;
}

Result<void> write_curves(const Json& result, const std::string& file) {
    std::ofstream out(file);
    for (const auto& curve : result.value("curves", Json::array())) {
        std::size_t rows = 0;
        std::string head;
        for (const auto& [key, value] : curve.items()) {
            head += (head.empty() ? "" : ",") + key;
            if (value.is_array()) rows = std::max(rows, value.size());
        }
        out << head << '\n';
        for (std::size_t row = 0; row < rows; ++row) {
            std::string text;
            for (const auto& [key, value] : curve.items()) {
                if (!text.empty()) text += ',';
                text += value.is_array()    ? (row < value.size() ? value[row].dump() : "")
                        : value.is_string() ? value.get<std::string>()
                                            : value.dump();
            }
            out << text << '\n';
        }
        out << '\n';
    }
    out.flush();
    if (!out) return Error{"file.write", file, "the curves could not be written", "Look whether the folder is there and has room."};
    return {};
}

}  // namespace taktwerk::apps
