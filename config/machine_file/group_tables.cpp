#include "config/machine_file/group_tables.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "axes/group/written_pose.hpp"
#include "axes/kinematics/kinematics.hpp"
#include "config/machine_file/group_arm.hpp"
#include "config/machine_file/group_equipment_tables.hpp"
#include "config/machine_file/group_quantities.hpp"
#include "config/reading/codecs.hpp"
#include "core/nearest_name.hpp"

namespace taktwerk::config {
namespace {

Codec<double> angle() { return angle_in_rad(); }
Codec<double> length() { return length_of_group(); }

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
                   },
                   {},
                   {}};
    table.before = [](Reader& reader, const Node&, J& joint) {
        const auto unit = reader.units_of_axes.find(joint.axis);
        if (unit != reader.units_of_axes.end()) reader.axis_unit = unit->second;
    };
    return table;
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
    f.push_back(field("joints", &A::joints, by_name(section(joint_table()), [](JointEntry& j) -> std::string& { return j.axis; }),
                      "senses, zeros and limits of members, by axis"));
    table.after = [](Reader& reader, const Node& node, A&) {
        int kinds = 0;  // also of one in which something is wrong
        for (const char* kind : {"cartesian", "core_xy", "beam_gantry", "scara", "palletizer", "rotary_delta", "linear_delta", "wrist"})
            kinds += node.find(kind) != nullptr ? 1 : 0;
        if (kinds == 1) return;
        reader.problem(node.at, "config.group_arm",
                       "`" + reader.path() + "` names " + (kinds == 0 ? "no arm" : std::to_string(kinds) + " arms"),
                       "write one of cartesian, core_xy, beam_gantry, scara, palletizer, rotary_delta, linear_delta, wrist");
    };
    return table;
}

/// Names that mean nothing, before anything is read in an axis' unit.
void check_names(Reader& reader, const Node& group, const std::string& name) {
    const auto* members = group.find("members");
    if (members == nullptr || members->kind != Node::Kind::list) return;
    std::vector<std::string> known;
    for (const auto& member : members->items) {
        if (std::find(known.begin(), known.end(), member.text) != known.end())
            reader.problem(member.at, "config.group_member", "axis '" + member.text + "' is twice a member of group " + name,
                           "name each axis once, in the order of the joints");
        else known.push_back(member.text);
    }
    const auto* kinematics = group.find("kinematics");
    const auto* joints = kinematics != nullptr ? kinematics->find("joints") : nullptr;
    if (joints == nullptr) return;
    for (const auto& joint : joints->entries) {
        if (std::find(known.begin(), known.end(), joint.key) != known.end()) continue;
        const auto near = nearest_name(joint.key, known);
        reader.problem(joint.at, "config.group_joint", "'" + joint.key + "' is no member of group " + name,
                       near.empty() ? "name a member, or add the axis to `members`" : "did you mean '" + near + "'?");
    }
}

void check_setup_velocity(Reader& reader, const Node& node, const GroupEntry& entry) {
    const auto* written = node.find("setup_velocity");
    if (written == nullptr) return;
    const auto most = parse_quantity("250 mm/s", Dimension::velocity, entry.unit);
    const double velocity = entry.group.setup_velocity;
    if (most.problem != QuantityProblem::none || (velocity > 0 && velocity <= most.value * (1 + 1e-12))) return;
    reader.problem(written->at, "group.setup_velocity",
                   "`setup_velocity` of group " + entry.group.name + " is " + show_number(velocity) + " " + entry.unit +
                       "/s; in set-up mode the tool's " + "point goes above 0 and at most 250 mm/s (reduced speed, ISO 10218-1)",
                   "write " + show_number(most.value) + " " + entry.unit + "/s or less, or leave it out: then that holds");
}

}  // namespace

Table<GroupEntry> group_table() {
    using G = GroupEntry;
    using axes::PathDynamics;
    const auto dynamics = [](double PathDynamics::*member) {
        return [member](G& g) -> double& { return g.group.default_dynamics.*member; };
    };
    Table<G> table{
        "groups.<name>", "Axes that move together on a path, by the name that programs use. Blocks: PLCopen Part 4.", {}, {}, {}};
    auto& f = table.fields;
    std::vector<std::pair<std::string, std::string>> lengths;
    for (const auto& unit : axis_units()) lengths.emplace_back(unit, unit);
    f.push_back(field("unit", &G::unit, choice<std::string>(lengths), "of lengths, paths and their speeds; before what is written in it"));
    f.push_back(required(field_at<G>(
        "members", [](G & g) -> auto& { return g.group.members; }, list(name()),
        "axes, from IdentInGroup 1 on; with kinematics the joints from the base on")));
    f.push_back(group<G>(
        "default", "How fast where a command does not say it; 0: what the axes' limits leave.",
        {
            field_at<G>("velocity", dynamics(&PathDynamics::velocity), quantity(Dimension::velocity, 0), "along the path"),
            field_at<G>("acceleration", dynamics(&PathDynamics::acceleration), quantity(Dimension::acceleration, 0), "along the path"),
            field_at<G>("deceleration", dynamics(&PathDynamics::deceleration), quantity(Dimension::acceleration, 0), "along the path"),
            field_at<G>("jerk", dynamics(&PathDynamics::jerk), quantity(Dimension::jerk, 0), "along the path"),
        }));
    f.push_back(
        with_default(field_at<G>(
                         "setup_velocity", [](G & g) -> auto& { return g.group.setup_velocity; }, quantity(Dimension::velocity),
                         "of the tool's point in set-up mode, whoever moves it, at most 250 mm/s (reduced speed, ISO 10218-1); so fast a "
                         "person jogs it, in manual mode too. No safety function"),
                     "250 mm/s"));
    auto arm = section(arm_table());
    const auto read = arm.read;
    arm.read = [read](Reader& reader, const Node& node, ArmEntry& entry) {
        const auto kept = reader.axis_unit;
        const bool good = read(reader, node, entry);
        reader.axis_unit = kept;
        return good;
    };
    f.push_back(field_via<G>(
        "kinematics", std::move(arm), [](G& g, const ArmEntry& written) { g.arm = std::make_shared<const ArmEntry>(written); },
        "the arm that they are", "none: ACS alone"));
    for (auto& equipment : equipment_fields()) f.push_back(std::move(equipment));
    table.before = [](Reader& reader, const Node& node, G& g) {
        const auto* unit = node.find("unit");
        const auto& known = axis_units();
        reader.axis_unit = unit != nullptr && std::find(known.begin(), known.end(), unit->text) != known.end() ? unit->text : g.unit;
        check_names(reader, node, g.group.name);
    };
    table.after = [](Reader& reader, const Node& node, G& g) {
        equip(reader, node, g);
        check_setup_velocity(reader, node, g);
    };
    return table;
}

axes::AxisGroupConfig made_of(Reader& reader, const GroupEntry& entry, const std::map<std::string, std::string, std::less<>>& units) {
    auto group = entry.group;
    if (const auto mm = parse_quantity("1 mm", Dimension::position, entry.unit); mm.problem == QuantityProblem::none)
        group.millimetre = mm.value;
    group.unit = entry.unit;
    if (!entry.arm || !entry.arm->arm) return group;
    const std::string here = "groups." + group.name + ".kinematics";
    const auto& written = *entry.arm;
    axes::KinematicsDescription description;
    description.arm = *written.arm;
    description.base = axes::pose_of_turns(written.base, written.tilt);
    const std::size_t count = std::min(group.members.size(), axes::max_joints);
    for (std::size_t i = 0; i < count; ++i) {
        const auto unit = units.find(group.members[i]);
        if (unit == units.end()) continue;  // told as an unknown axis
        auto& joint = description.joints[i];
        const auto as_length = parse_quantity("1 " + unit->second, Dimension::position, entry.unit);
        const auto as_angle = parse_quantity("1 " + unit->second, Dimension::position, "rad");
        if (as_angle.problem == QuantityProblem::none) joint.unit = as_angle.value;
        else if (as_length.problem == QuantityProblem::none) joint.unit = as_length.value;
        const auto own =
            std::find_if(written.joints.begin(), written.joints.end(), [&](const auto& j) { return j.axis == group.members[i]; });
        if (own == written.joints.end()) continue;
        joint.sign = own->reversed ? -1 : 1;
        joint.zero = own->zero * joint.unit;
        if (own->limits) {
            joint.low = own->limits->first * joint.unit;
            joint.high = own->limits->second * joint.unit;
        }
    }
    auto made = axes::Kinematics::make(description);
    if (!made.ok()) {
        // Where it names a length, there.
        const auto& why = made.error();
        const auto kind = kind_of(description.arm);
        const std::string arm = here + "." + (kind == "six_joints" ? "wrist" : std::string{kind});
        reader.problem_in(arm + "." + why.what.substr(0, why.what.find(' ')), why.code, "`" + arm + "`: " + why.what, why.remedy);
        return group;
    }
    group.kinematics = std::make_shared<const axes::Kinematics>(made.value());
    const auto& rotary = group.kinematics->rotary();
    for (std::size_t i = 0; i < std::min(count, group.kinematics->joint_count()); ++i) {
        const auto unit = units.find(group.members[i]);
        if (unit == units.end()) continue;
        const bool turns = parse_quantity("1 " + unit->second, Dimension::position, "rad").problem == QuantityProblem::none;
        if (turns != rotary[i])
            reader.problem_in("groups." + group.name + ".members", "config.group_unit",
                              "axis " + group.members[i] + " counts in " + unit->second + ", and joint " + std::to_string(i + 1) +
                                  " of a " + std::string{kind_of(description.arm)} + " is " + (rotary[i] ? "an angle" : "a length"),
                              "put the members into the order of the joints, from the base on, or correct the axis' `unit`");
    }
    return group;
}

}  // namespace taktwerk::config
