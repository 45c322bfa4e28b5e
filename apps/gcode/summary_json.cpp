#include "apps/gcode/summary_json.hpp"

namespace taktwerk::apps {
namespace {

using GcodeJson = nlohmann::ordered_json;

GcodeJson list_of(const std::vector<Error>& errors) {
    auto all = GcodeJson::array();
    for (const auto& error : errors)
        all.push_back({{"code", error.code}, {"subject", error.subject}, {"what", error.what}, {"remedy", error.remedy}});
    return all;
}

GcodeJson moves_json(const gcode::ProgramSummary::Moves& moves) { return {{"count", moves.count}, {"length_mm", moves.length_mm}}; }

}  // namespace

GcodeJson program_json(const CheckedProgram& program, const std::string& name) {
    using Kind = gcode::Handshake::Kind;
    const auto& summary = program.summary;
    const auto count = [&](Kind kind) { return summary.handshakes()[static_cast<std::size_t>(kind)]; };
    GcodeJson out{{"ok", true}, {"file", name}, {"lines", program.counts.lines}, {"blocks", program.counts.blocks}};
    out["end"] = program.end.number == 0 ? "%" : "M" + std::to_string(program.end.number);
    auto extents = GcodeJson::object();
    for (std::size_t axis = 0; axis < gcode::axis_count; ++axis)
        if (const auto& extent = summary.extents()[axis]; extent.moved)
            extents[std::string(1, gcode::axis_letters[axis])] = {
                {"least", extent.least}, {"most", extent.most}, {"unit", axis < gcode::linear_axes ? "mm" : "deg"}};
    out["extents"] = std::move(extents);
    out["rapids"] = moves_json(summary.rapids()), out["lines_with_feed"] = moves_json(summary.lines()),
    out["arcs"] = moves_json(summary.arcs());
    out["standing"] = program.counts.standing;
    out["feed_mm_per_min"] = {{"least", summary.feeds().least * 60}, {"most", summary.feeds().most * 60}};
    if (summary.spindle().used) out["spindle_per_min"] = {{"least", summary.spindle().least}, {"most", summary.spindle().most}};
    out["tools"] = summary.tools();
    out["dwells"] = {{"count", summary.dwells().count}, {"seconds", summary.dwells().seconds}};
    out["acknowledged"] = {{"program_stops", count(Kind::program_stop)},
                           {"optional_stops", count(Kind::optional_stop)},
                           {"tool_changes", count(Kind::tool_change)},
                           {"spindle", count(Kind::spindle_clockwise) + count(Kind::spindle_counter) + count(Kind::spindle_off)},
                           {"coolant", count(Kind::mist) + count(Kind::flood) + count(Kind::coolant_off)},
                           {"user", count(Kind::user)}};
    out["left_out"] = program.counts.left_out;
    out["least_seconds"] = summary.least_seconds();
    out["messages"] = program.messages;
    if (program.start_line > 1)
        out["start"] = {{"line", static_cast<std::uint32_t>(program.start_line)},
                        {"x", program.start[0]},
                        {"y", program.start[1]},
                        {"z", program.start[2]},
                        {"tool", program.with.tool}};
    out["warnings"] = list_of(remarks(program, name));
    return out;
}

GcodeJson program_errors_json(const std::vector<Error>& errors) { return {{"ok", false}, {"errors", list_of(errors)}}; }

}  // namespace taktwerk::apps
