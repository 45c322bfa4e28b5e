#include "config/machine_file/group_arm_tables.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "config/machine_file/group_quantities.hpp"
#include "config/reading/codecs.hpp"
#include "core/nearest_name.hpp"

namespace taktwerk::config {
namespace {

Codec<double> angle() { return angle_in_rad(); }
Codec<double> length() { return length_of_group(); }

constexpr std::array<std::string_view, 9> arms{"cartesian",    "core_xy",      "beam_gantry", "scara", "palletizer",
                                               "rotary_delta", "linear_delta", "wrist",       "dh"};

template <class Shape>
Table<Shape> shape_table(std::string title, std::string doc, std::vector<Field<Shape>> fields) {
    return {"groups.<name>.kinematics." + std::move(title), std::move(doc), std::move(fields), {}, {}};
}

/// One key a kind; what it reads becomes the arm.
template <class Shape>
Field<ArmEntry> kind_of_arm(std::string key, Table<Shape> table, std::string doc) {
    return field_via<ArmEntry>(
        std::move(key), section(std::move(table)), [](ArmEntry& entry, const Shape& shape) { entry.arm = axes::ArmDescription{shape}; },
        std::move(doc), "none");
}

struct CartesianEntry {
    std::string linear = "XYZ", turn;
};

Field<ArmEntry> cartesian_field() {
    using C = CartesianEntry;
    auto table =
        shape_table<C>("cartesian", "Two or three axes at right angles, and if wanted a turn behind them.",
                       {
                           field("axes", &C::linear, choice<std::string>({{"XYZ", "XYZ"}, {"XY", "XY"}, {"XZ", "XZ"}, {"YZ", "YZ"}}),
                                 "which of them there are, in the order of the members"),
                           with_default(field("turn", &C::turn, choice<std::string>({{"A", "A"}, {"B", "B"}, {"C", "C"}}),
                                              "the last member turns the tool about X (A), Y (B) or Z (C)"),
                                        "none"),
                       });
    return field_via<ArmEntry>(
        "cartesian", section(std::move(table)),
        [](ArmEntry& entry, const C& c) {
            axes::CartesianAxes arm;
            for (std::size_t i = 0; i < 3; ++i) arm.linear[i] = c.linear.find("XYZ"[i]) != std::string::npos;
            arm.turn_about = c.turn.empty() ? -1 : c.turn[0] - 'A';
            entry.arm = axes::ArmDescription{arm};
        },
        "X, Y, Z at right angles", "none");
}

struct DhEntry {
    axes::DhConvention convention = axes::DhConvention::classic;
    std::vector<axes::DhRow> rows;
};

Field<ArmEntry> dh_field() {
    using D = DhEntry;
    using Row = axes::DhRow;
    Table<Row> row{"groups.<name>.kinematics.dh.rows[]",
                   "One joint after the other, from the base on.",
                   {field("a", &Row::a, length(), "along the X that both axes have at right angles"),
                    field("alpha", &Row::alpha, angle(), "the turn about it from one axis to the next"),
                    field("d", &Row::d, length(), "along the joint's axis"),
                    field("theta", &Row::theta, angle(), "about the joint's axis, where the joint is at 0")},
                   {},
                   {}};
    auto table = shape_table<D>(
        "dh", "Denavit and Hartenberg's table. One that is read in the wrong convention is another arm.",
        {required(field("convention", &D::convention,
                        choice<axes::DhConvention>({{"classic", axes::DhConvention::classic}, {"modified", axes::DhConvention::modified}}),
                        "classic: Rz Tz Tx Rx; modified: Rx Tx Rz Tz (Craig), a and alpha of the link in front of the joint")),
         required(field("rows", &D::rows, list(section(std::move(row))), "six"))});
    table.after = [](Reader& reader, const Node& node, D& dh) {
        constexpr std::size_t joints = std::tuple_size_v<axes::DhTable>;
        const auto* rows = node.find("rows");
        if (rows == nullptr || rows->kind != Node::Kind::list || dh.rows.size() == joints) return;
        reader.problem(rows->at, "config.group_arm", "the table has " + std::to_string(dh.rows.size()) + " rows, and the arm six joints",
                       "write a row a joint, from the base to the flange");
    };
    return field_via<ArmEntry>(
        "dh", section(std::move(table)),
        [](ArmEntry& entry, const D& dh) {
            axes::SixJoints::Table written{{}, dh.convention};
            std::copy_n(dh.rows.begin(), std::min(dh.rows.size(), written.rows.size()), written.rows.begin());
            axes::SixJoints six;
            six.geometry = written;
            entry.arm = axes::ArmDescription{six};
        },
        "six joints by a table: three parallel axes, a spherical wrist, or near one of them", "none");
}

Table<DeviationEntry> deviation_table() {
    Table<DeviationEntry> table{
        "groups.<name>.kinematics.deviations.<axis>",
        "By what calibration found the link behind this joint to differ, in the next joint's frame: shift, then turn.",
        {},
        {},
        {}};
    six_fields<DeviationEntry>(
        table.fields, [](DeviationEntry& d) -> axes::SixNumbers& { return d.six; }, "the link's end");
    return table;
}

Codec<MovedBy> ratio_of_joint() {
    const auto ratio = number();
    Codec<MovedBy> c;
    c.shape = ratio.shape;
    c.read = [ratio](Reader& reader, const Node& node, MovedBy& by) { return ratio.read(reader, node, by.ratio); };
    return c;
}

Table<JointEntry> joint_table() {
    using J = JointEntry;
    Table<J> table{"groups.<name>.kinematics.joints.<axis>",
                   "How this member counts its joint, in its own unit. Without it: as the arm's picture does.",
                   {
                       field("reversed", &J::reversed, boolean(), "it counts against the picture"),
                       field("zero", &J::zero, quantity(Dimension::position), "where the arm of the picture stands when the axis is at 0"),
                       with_default(field("limits", &J::limits, maybe(interval(Dimension::position)),
                                          "of the joint, beside the axis' software limits; they hold without homing too"),
                                    "none"),
                       field("moved_by", &J::moved_by, by_name(ratio_of_joint(), [](MovedBy& by) -> std::string& { return by.axis; }),
                             "a gear in which this motor goes with another member's joint: by how much for one of that, each in its "
                             "axis' unit"),
                   },
                   {},
                   {}};
    table.before = [](Reader& reader, const Node&, J& joint) {
        auto unit = reader.units_of_axes.find(joint.axis);
        if (unit == reader.units_of_axes.end()) {  // told as no member; its numbers are as the one's that was meant
            std::vector<std::string> names;
            for (const auto& [name, its_unit] : reader.units_of_axes) names.push_back(name);
            unit = reader.units_of_axes.find(nearest_name(joint.axis, names));
        }
        if (unit != reader.units_of_axes.end()) reader.axis_unit = unit->second;
    };
    return table;
}

}  // namespace

bool report_arm_word(Reader& reader, const Node& word) {
    const auto kind = nearest_name(word.text, {arms.begin(), arms.end()});
    if (kind.empty()) return false;
    reader.problem(word.at, "config.group_arm", "`" + reader.path() + "` has its arm as a value, `" + word.text + "`",
                   "the kind is a key, with the lengths in it: `" + kind + ": { ... }`");
    return true;
}

Table<ArmEntry> arm_table() {
    using A = ArmEntry;
    using namespace axes;
    using CoreXy = CoreXyAxes;
    using Beam = BeamGantryShape;
    using Scara = ScaraLengths;
    using Pal = PalletizerLengths;
    using Rot = RotaryDeltaLengths;
    using Lin = LinearDeltaLengths;
    using Wrist6 = WristArmLengths;
    Table<A> table{"groups.<name>.kinematics",
                   "The arm: one kind of docs/motion/kinematics.md. Its joints are the members, from the base on.",
                   {},
                   {},
                   {}};
    auto& f = table.fields;
    f.push_back(cartesian_field());
    f.push_back(kind_of_arm("core_xy",
                            shape_table<CoreXy>("core_xy", "One belt, two motors: the first moves by x + y, the second by x - y.",
                                                {field("lift", &CoreXy::lift, boolean(), "a third member is Z"),
                                                 field("turns", &CoreXy::turns, boolean(), "the last member is C")}),
                            "CoreXY or H-bot"));
    f.push_back(kind_of_arm("beam_gantry",
                            shape_table<Beam>("beam_gantry", "A beam with a motor at either end: members X1, X2, Y, Z.",
                                              {required(field("span", &Beam::span, length(), "between the guides")),
                                               field("turns", &Beam::turns, boolean(), "a fifth member is C")}),
                            "gantry with two masters"));
    f.push_back(kind_of_arm("scara",
                            shape_table<Scara>("scara", "Two links in the plane, a lift, a turn.",
                                               {required(field("first", &Scara::first, length(), "axis 1 to axis 2")),
                                                required(field("second", &Scara::second, length(), "axis 2 to axis 4")),
                                                field("height", &Scara::height, length(), "of the flange when the lift is at 0")}),
                            "SCARA"));
    f.push_back(kind_of_arm("palletizer",
                            shape_table<Pal>("palletizer", "Column, two links with parallelograms, flange.",
                                             {field("shoulder", &Pal::shoulder, length(), "axis 1 to axis 2, forward"),
                                              field("height", &Pal::height, length(), "base to axis 2"),
                                              required(field("upper", &Pal::upper, length(), "axis 2 to axis 3")),
                                              required(field("fore", &Pal::fore, length(), "axis 3 to the wrist")),
                                              field("wrist", &Pal::wrist, length(), "the wrist to the flange's axis, forward"),
                                              field("drop", &Pal::drop, length(), "the wrist to the flange, down")}),
                            "palletizer of four axes"));
    f.push_back(kind_of_arm(
        "rotary_delta",
        shape_table<Rot>(
            "rotary_delta", "Three upper arms with forearms of parallel rods.",
            {required(field("base_radius", &Rot::base_radius, length(), "axis of an upper arm to the middle of the base")),
             required(field("platform_radius", &Rot::platform_radius, length(), "joint of a rod to the platform's middle")),
             required(field("upper", &Rot::upper, length(), "upper arm")), required(field("rod", &Rot::rod, length(), "forearm")),
             field("first_arm_at", &Rot::first_arm_at, angle(), "direction of the first arm, counter-clockwise from X"),
             field("turns", &Rot::turns, boolean(), "a fourth member turns the tool")}),
        "delta with rotary axes"));
    f.push_back(kind_of_arm(
        "linear_delta",
        shape_table<Lin>("linear_delta", "Three carriages on upright rails.",
                         {required(field("base_radius", &Lin::base_radius, length(), "joint of a rod at its carriage to the middle")),
                          required(field("platform_radius", &Lin::platform_radius, length(), "joint of a rod to the platform's middle")),
                          required(field("rod", &Lin::rod, length(), "of a rod")),
                          field("first_arm_at", &Lin::first_arm_at, angle(), "direction of the first rail, counter-clockwise from X"),
                          field("turns", &Lin::turns, boolean(), "a fourth member turns the tool")}),
        "delta with linear axes"));
    auto wrist = shape_table<Wrist6>(
        "wrist", "Six joints whose last three axes meet in a point.",
        {field("a1", &Wrist6::a1, length(), "axis 1 to axis 2, forward"),
         field("a2", &Wrist6::a2, length(), "axis 3 to the wrist's centre, forward"),
         field("b", &Wrist6::b, length(), "axis 1 to the wrist's centre, to the left"),
         field("c1", &Wrist6::c1, length(), "base to axis 2, up"), required(field("c2", &Wrist6::c2, length(), "axis 2 to axis 3")),
         required(field("c3", &Wrist6::c3, length(), "axis 3 to the wrist's centre, up")),
         field("c4", &Wrist6::c4, length(), "the wrist's centre to the flange")});
    f.push_back(field_via<A>(
        "wrist", section(std::move(wrist)),
        [](A& entry, const Wrist6& lengths) {
            SixJoints six;
            six.geometry = lengths;
            entry.arm = ArmDescription{six};
        },
        "six joints with a spherical wrist", "none"));
    f.push_back(dh_field());
    f.push_back(group<A>("base", "Where the arm is mounted, seen from the machine.",
                         {
                             field_at<A>(
                                 "x", [](A& a) -> double& { return a.base[0]; }, length(), "of its origin"),
                             field_at<A>(
                                 "y", [](A& a) -> double& { return a.base[1]; }, length(), "of its origin"),
                             field_at<A>(
                                 "z", [](A& a) -> double& { return a.base[2]; }, length(), "of its origin"),
                             field_at<A>(
                                 "rx", [](A& a) -> double& { return a.tilt[0]; }, angle(), "turned about the new X last"),
                             field_at<A>(
                                 "ry", [](A& a) -> double& { return a.tilt[1]; }, angle(), "then about the new Y"),
                             field_at<A>(
                                 "rz", [](A& a) -> double& { return a.tilt[2]; }, angle(), "first about Z"),
                         }));
    f.push_back(field("deviations", &A::deviations,
                      by_name(section(deviation_table()), [](DeviationEntry& d) -> std::string& { return d.axis; }),
                      "of six joints: how this very arm differs from the written one, by axis; its inverse is then Newton's"));
    f.push_back(field("joints", &A::joints, by_name(section(joint_table()), [](JointEntry& j) -> std::string& { return j.axis; }),
                      "senses, zeros and limits of members, by axis"));
    table.instead = {{"kind", "the kind is a key of its own"}, {"type", "the kind is a key of its own"}};
    table.after = [](Reader& reader, const Node& node, A&) {
        int kinds = 0;  // also of one in which something is wrong
        for (const auto& kind : arms) kinds += node.find(kind) != nullptr ? 1 : 0;
        if (kinds == 1) return;
        if (kinds == 0) {
            for (const char* key : {"kind", "type"})
                if (const Node* word = node.find(key);
                    word != nullptr && word->kind == Node::Kind::scalar && report_arm_word(reader, *word))
                    return;
            for (const auto& entry : node.entries)
                if (!nearest_name(entry.key, {arms.begin(), arms.end()}).empty()) return;  // told as misspelt
        }
        reader.problem(node.at, "config.group_arm",
                       "`" + reader.path() + "` names " + (kinds == 0 ? "no arm" : std::to_string(kinds) + " arms"),
                       "write one of cartesian, core_xy, beam_gantry, scara, palletizer, rotary_delta, linear_delta, wrist, dh");
    };
    return table;
}

}  // namespace taktwerk::config
