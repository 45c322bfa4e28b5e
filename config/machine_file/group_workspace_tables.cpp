#include "config/machine_file/group_workspace_tables.hpp"

#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "axes/group/workspace.hpp"
#include "axes/group/written_pose.hpp"
#include "axes/pose_math.hpp"
#include "config/machine_file/group_quantities.hpp"

namespace taktwerk::config {
namespace {

using Interval = std::optional<std::pair<double, double>>;

/// As it is written: intervals seen from a frame.
struct RoomEntry {
    std::string name;
    bool kept_free = false;
    std::array<Interval, 3> sides{};
    std::optional<double> radius;
    axes::SixNumbers frame{};
};

Codec<std::pair<double, double>> side_of_room() {
    auto c = interval(Dimension::position);
    c.read = [read = c.read](Reader& reader, const Node& node, std::pair<double, double>& out) {
        return read(reader, node, out) && check_size(reader, node.items[0], out.first) && check_size(reader, node.items[1], out.second);
    };
    return c;
}

Table<RoomEntry> room_table() {
    using R = RoomEntry;
    Table<R> table{
        "groups.<name>.workspace.<name>",
        "A room in the machine (MCS), by a name for people: a box, or with `radius` a cylinder along Z. A side that is left out has no "
        "end. Not safety-rated.",
        {},
        {},
        {}};
    auto& f = table.fields;
    f.push_back(field("kept_free", &R::kept_free, boolean(), "the tool's point stays out of it; else it stays inside one of the others"));
    const auto side = [&](const char* key, std::size_t i, const char* doc) {
        f.push_back(with_default(field_at<R>(
                                     key, [i](R & r) -> auto& { return r.sides[i]; }, maybe(side_of_room()), doc),
                                 "without an end"));
    };
    side("x", 0, "from where to where, in its frame");
    side("y", 1, "likewise");
    side("z", 2, "likewise");
    f.push_back(with_default(field("radius", &R::radius, maybe(quantity(Dimension::position, 0)), "of a cylinder about the frame's Z"),
                             "none: a box"));
    std::vector<Field<axes::SixNumbers>> numbers;
    six_fields<axes::SixNumbers>(
        numbers, [](axes::SixNumbers& six) -> axes::SixNumbers& { return six; }, "its origin");
    Table<axes::SixNumbers> frame{
        "groups.<name>.workspace.<name>.frame", "Where the room's own frame stands in the machine.", std::move(numbers), {}, {}};
    f.push_back(field_via<R>(
        "frame", section(std::move(frame)), [](R& r, const axes::SixNumbers& six) { r.frame = six; }, "in which the sides are counted",
        "the machine's"));
    table.instead = {{"diameter", "write `radius`, half of it"}, {"height", "write `z: [..., ...]`, from where to where"}};
    for (const char* key : {"forbidden", "keep_out", "keepout", "exclude"}) table.instead.emplace_back(key, "write `kept_free: true`");
    for (const char* key : {"center", "centre", "position", "origin"})
        table.instead.emplace_back(key, "write `frame: { x: ..., y: ..., z: ... }`, from which the sides are counted");
    table.after = [](Reader& reader, const Node& node, R&) {
        const auto written = [&](const char* key) { return node.find(key) != nullptr; };  // also wrongly: that is told already
        const bool sides = written("x") || written("y"), radius = written("radius");
        if (radius && sides)
            reader.problem(node.at, "config.group_room", "`" + reader.path() + "` has a radius and sides along x or y",
                           "write `radius` and `z` for a cylinder, x, y, z for a box; its middle is that of `frame`");
        else if (!radius && !sides && !written("z"))
            reader.problem(node.at, "config.group_room", "`" + reader.path() + "` has no side at all",
                           "write from where to where it goes, such as x: [-400 mm, 400 mm]");
    };
    return table;
}

axes::WorkspaceRoom made_of(const RoomEntry& written) {
    constexpr double endless = std::numeric_limits<double>::infinity();
    axes::WorkspaceRoom room;
    room.name = written.name;
    room.kept_free = written.kept_free;
    axes::Pose middle;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& side = written.sides[i];
        middle.position[i] = side ? (side->first + side->second) / 2 : 0;
        room.half[i] = side ? (side->second - side->first) / 2 : endless;
    }
    if (written.radius) {
        room.shape = axes::WorkspaceRoom::Shape::cylinder;
        room.half[0] = room.half[1] = *written.radius;
    }
    room.middle = axes::composed(axes::pose_of_numbers(written.frame), middle);
    return room;
}

}  // namespace

std::vector<Field<GroupEntry>> workspace_fields() {
    using G = GroupEntry;
    std::vector<Field<G>> fields;
    fields.push_back(field_via<G>(
        "workspace", by_name(section(room_table()), [](RoomEntry& room) -> std::string& { return room.name; }),
        [](G& g, const std::vector<RoomEntry>& written) {
            auto space = std::make_shared<axes::Workspace>();
            for (const auto& room : written) space->rooms.push_back(made_of(room));
            g.group.workspace = std::move(space);
        },
        "where the tool's point may be on a path or a jog; looked at before it moves", "anywhere"));
    fields.push_back(
        group<G>("following_error", "Of the tool's point on its path; beyond it the group comes to rest (path_following_error).",
                 {
                     with_default(field_at<G>(
                                      "window", [](G& g) -> double& { return g.group.following.window; }, quantity(Dimension::position, 0),
                                      "from where it should be"),
                                  "nobody looks"),
                     field_at<G>(
                         "time", [](G& g) -> Duration& { return g.group.following.time; }, duration(), "beyond it for longer than this"),
                 }));
    return fields;
}

}  // namespace taktwerk::config
