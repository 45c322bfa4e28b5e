#include "config/machine_file/group_equipment_tables.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "config/machine_file/group_quantities.hpp"
#include "core/nearest_name.hpp"

namespace taktwerk::config {
namespace {

using axes::SixNumbers;

Table<SixNumbers> frame_table(std::string title, std::string doc) {
    Table<SixNumbers> table{"groups.<name>.frames." + std::move(title), std::move(doc), {}, {}, {}};
    six_fields<SixNumbers>(
        table.fields, [](SixNumbers& six) -> SixNumbers& { return six; }, "its origin");
    return table;
}

void body_fields(std::vector<Field<CarriedEntry>>& into) {
    using C = CarriedEntry;
    into.push_back(field_at<C>(
        "mass", [](C& c) -> double& { return c.body.mass; }, quantity(Dimension::mass, 0), "no set-point depends on it"));
    std::vector<Field<SixNumbers>> centre;
    six_fields<SixNumbers>(
        centre, [](SixNumbers& six) -> SixNumbers& { return six; }, "the centre of gravity");
    Table<SixNumbers> table{
        "groups.<name>.tools.<name>.centre", "Seen from the tool's point; turned as the principal axes are.", std::move(centre), {}, {}};
    into.push_back(field_via<C>(
        "centre", section(std::move(table)), [](C& c, const SixNumbers& six) { c.body.centre = six; }, "of gravity", "the tool's point"));
    constexpr const char* keys[] = {"ix", "iy", "iz"};
    for (std::size_t i = 0; i < 3; ++i)
        into.push_back(field_at<C>(
            keys[i], [i](C& c) -> double& { return c.body.inertia[i]; }, quantity(Dimension::inertia, 0),
            "about a principal axis through the centre of gravity"));
}

Table<CarriedEntry> carried_table(const std::string& kind, std::string doc, bool has_point) {
    using C = CarriedEntry;
    Table<C> table{"groups.<name>." + kind + ".<name>", std::move(doc), {}, {}, {}};
    table.fields.push_back(required(field("number", &C::number, integer<std::uint8_t>(1, axes::tool_numbers - 1),
                                          "by which programs call it; 0 is the flange, or nothing")));
    if (has_point)
        six_fields<C>(
            table.fields, [](C& c) -> SixNumbers& { return c.frame; }, "the tool's point, seen from the flange");
    body_fields(table.fields);
    if (has_point) table.instead = {{"length", "write `z`: its point is seen from the flange"}};
    else
        for (const char* key : {"x", "y", "z"}) table.instead.emplace_back(key, "write it under `centre: { ... }`, the centre of gravity");
    return table;
}

const CarriedEntry* find(const std::vector<CarriedEntry>& all, const std::string& name) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
    return found == all.end() ? nullptr : &*found;
}

void check_numbers(Reader& reader, const Node& node, const char* key, const std::vector<CarriedEntry>& all) {
    std::set<std::uint8_t> taken;
    for (const auto& one : all) {
        if (one.number == 0 || taken.insert(one.number).second) continue;  // 0: told as missing
        const Node* section = node.find(key);
        const Node* own = section != nullptr ? section->find(one.name) : nullptr;
        reader.problem(own != nullptr ? own->at : node.at, "config.group_number",
                       "number " + std::to_string(one.number) + " is another one's of `" + key + "` already",
                       "give each a number of its own");
    }
}

std::uint8_t selected(Reader& reader, const Node& node, const char* key, const std::string& name, const std::vector<CarriedEntry>& all) {
    if (name.empty()) return 0;
    if (const auto* found = find(all, name)) return found->number;
    std::vector<std::string> names;
    for (const auto& one : all) names.push_back(one.name);
    const auto near = nearest_name(name, names);
    const Node *own = node.find(key), *section = node.find(std::string(key) + "s");
    if (section != nullptr && section->kind != Node::Kind::map) return 0;  // told already: nobody knows what it would have had
    reader.problem(own != nullptr ? own->at : node.at, "config.group_selected", "`" + std::string(key) + "s` has no '" + name + "'",
                   near.empty() ? "name one of `" + std::string(key) + "s`, or leave it out for number 0" : "did you mean '" + near + "'?");
    return 0;
}

}  // namespace

std::vector<Field<GroupEntry>> equipment_fields() {
    using G = GroupEntry;
    std::vector<Field<G>> fields;
    const auto frame = [&](std::string key, std::string doc, auto get) {
        return field_via<G>(
            key, section(frame_table(key, doc)), [get](G& g, const SixNumbers& six) { get(g) = six; }, doc, "0");
    };
    std::vector<Field<G>> frames;
    frames.push_back(frame("machine", "Where the machine (MCS) stands in the world (WCS).",
                           [](G& g) -> SixNumbers& { return g.group.equipment.frames.machine; }));
    for (std::size_t i = 0; i < axes::product_frames; ++i)
        frames.push_back(frame("pcs_" + std::to_string(i + 1), "Where this product's frame stands in the world at the beginning.",
                               [i](G& g) -> SixNumbers& { return g.group.equipment.frames.product[i]; }));
    fields.push_back(
        group<G>("frames", "Frames in which programs give positions; MC_SetCoordinateTransform changes them.", std::move(frames),
                 {{"mcs", "where the machine (MCS) stands in the world is `machine`"}, {"pcs", "write which one, such as `pcs_1`"}}));
    const auto name_of = [](CarriedEntry& c) -> std::string& { return c.name; };
    fields.push_back(
        field("tools", &G::tools,
              by_name(section(carried_table("tools", "A tool, by a name that the file alone knows; MC_GroupSelectTool.", true)), name_of),
              "what may be at the flange"));
    fields.push_back(
        field("payloads", &G::payloads,
              by_name(section(carried_table("payloads", "A payload, by a name that the file alone knows; MC_GroupSelectPayload.", false)),
                      name_of),
              "what the tool may carry"));
    fields.push_back(with_default(field("tool", &G::tool, name(), "of `tools`: which one is selected at the beginning"), "the flange"));
    fields.push_back(with_default(field("payload", &G::payload, name(), "of `payloads`: likewise"), "none"));
    return fields;
}

void equip(Reader& reader, const Node& node, GroupEntry& entry) {
    auto& equipment = entry.group.equipment;
    if (node.find("kinematics") == nullptr)
        for (const char* key : {"frames", "tools", "workspace", "setup_velocity"})
            if (const Node* own = node.find(key))
                reader.problem(own->at, "config.group_frames", "the group has `" + std::string(key) + "` and no arm that could have it",
                               "write `kinematics:`, or leave it out");
    check_numbers(reader, node, "tools", entry.tools);
    check_numbers(reader, node, "payloads", entry.payloads);
    for (const auto& tool : entry.tools) (void)equipment.tools.define(tool.number, {tool.frame, tool.body});
    for (const auto& payload : entry.payloads) (void)equipment.payloads.define(payload.number, payload.body);
    equipment.selected_tool = selected(reader, node, "tool", entry.tool, entry.tools);
    equipment.selected_payload = selected(reader, node, "payload", entry.payload, entry.payloads);
}

}  // namespace taktwerk::config
