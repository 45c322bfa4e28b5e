#include "config/machine_file/group_tables.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "axes/group/written_pose.hpp"
#include "axes/kinematics/kinematics.hpp"
#include "config/machine_file/group_arm.hpp"
#include "config/machine_file/group_arm_tables.hpp"
#include "config/machine_file/group_equipment_tables.hpp"
#include "config/machine_file/group_quantities.hpp"
#include "config/machine_file/group_workspace_tables.hpp"
#include "config/reading/codecs.hpp"
#include "core/nearest_name.hpp"

namespace taktwerk::config {
namespace {

/// Names that mean nothing, before anything is read in an axis' unit.
void check_names(Reader& reader, const Node& group, const std::string& name) {
    const auto* members = group.find("members");
    if (members == nullptr || members->kind != Node::Kind::list) return;
    std::vector<std::string> known;
    std::vector<const Node*> named;  // what is no word is told by its own codec
    for (const auto& member : members->items)
        if (member.kind == Node::Kind::scalar && !member.text.empty() && std::isalpha(static_cast<unsigned char>(member.text.front())) != 0)
            named.push_back(&member);
    for (const Node* node : named) {
        const auto& member = *node;
        if (std::find(known.begin(), known.end(), member.text) != known.end())
            reader.problem(member.at, "config.group_member", "axis '" + member.text + "' is twice a member of group " + name,
                           "name each axis once, in the order of the joints");
        else known.push_back(member.text);
    }
    const auto* kinematics = group.find("kinematics");
    if (kinematics == nullptr) return;
    // A member that is no axis is told here, with its place; what stands below by the axis' right name is not accused for it.
    std::vector<std::string> axes;
    for (const auto& [axis, unit] : reader.units_of_axes) axes.push_back(axis);
    const auto is_axis = [&](const std::string& of) { return std::find(axes.begin(), axes.end(), of) != axes.end(); };
    for (const Node* node : named) {
        const auto& member = *node;
        if (is_axis(member.text)) continue;
        const auto near = nearest_name(member.text, axes);
        reader.problem(member.at, "config.group_member", "there is no axis '" + member.text + "'",
                       near.empty() ? "name an axis of `axes`" : "did you mean '" + near + "'?");
        if (!near.empty()) known.push_back(near);
    }
    const auto check = [&](const Node& by_axis) {
        for (const auto& entry : by_axis.entries) {
            if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
            const auto near = nearest_name(entry.key, known);
            reader.problem(entry.at, "config.group_joint", "'" + entry.key + "' is no member of group " + name,
                           near.empty() ? "name a member, or add the axis to `members`" : "did you mean '" + near + "'?");
        }
    };
    if (const auto* deviations = kinematics->find("deviations")) check(*deviations);
    const auto* joints = kinematics->find("joints");
    if (joints == nullptr) return;
    check(*joints);
    for (const auto& joint : joints->entries) {
        const auto* moved_by = joint.value.find("moved_by");
        if (moved_by == nullptr) continue;
        check(*moved_by);
        for (const auto& by : moved_by->entries)
            if (by.key == joint.key)
                reader.problem(by.at, "config.group_joint", "'" + joint.key + "' moves its own joint anyway",
                               "name another member's joint with which this motor goes; how far its own goes is the axis' `gearing`");
    }
}

std::size_t place_of(const axes::AxisGroupConfig& group, const std::string& axis) {
    return static_cast<std::size_t>(std::find(group.members.begin(), group.members.end(), axis) - group.members.begin());
}

/// `joints:`, with the units of the axes.
void count_joints(axes::KinematicsDescription& description, const axes::AxisGroupConfig& group, const ArmEntry& written,
                  const std::string& unit_of_group, const std::map<std::string, std::string, std::less<>>& units) {
    const std::size_t count = std::min(group.members.size(), axes::max_joints);
    for (std::size_t i = 0; i < count; ++i) {
        const auto unit = units.find(group.members[i]);
        if (unit == units.end()) continue;  // told as an unknown axis
        const auto as_length = parse_quantity("1 " + unit->second, Dimension::position, unit_of_group);
        const auto as_angle = parse_quantity("1 " + unit->second, Dimension::position, "rad");
        if (as_angle.problem == QuantityProblem::none) description.joints[i].unit = as_angle.value;
        else if (as_length.problem == QuantityProblem::none) description.joints[i].unit = as_length.value;
    }
    for (const auto& own : written.joints) {
        const auto i = place_of(group, own.axis);
        if (i >= count) continue;  // told as no member
        auto& joint = description.joints[i];
        joint.sign = own.reversed ? -1 : 1;
        joint.zero = own.zero * joint.unit;
        if (own.limits) {
            joint.low = own.limits->first * joint.unit;
            joint.high = own.limits->second * joint.unit;
        }
        for (const auto& by : own.moved_by)
            if (const auto other = place_of(group, by.axis); other < count && other != i)  // else told
                description.coupling[i][other] = by.ratio * joint.unit / description.joints[other].unit;
    }
}

/// `deviations:`, which only six joints have.
void deviate(Reader& reader, axes::KinematicsDescription& description, const axes::AxisGroupConfig& group, const ArmEntry& written,
             const std::string& here) {
    if (written.deviations.empty()) return;
    auto* six = std::get_if<axes::SixJoints>(&description.arm);
    if (six == nullptr) {
        reader.problem_in(here + ".deviations", "config.group_arm",
                          "`" + here + "` has `deviations`, and only arms of six joints (wrist, dh) can differ from what is written",
                          "leave them out; `zero` of a joint corrects its offset");
        return;
    }
    for (const auto& found : written.deviations) {
        const auto i = place_of(group, found.axis);
        if (i >= six->deviations.size()) continue;  // told as no member
        std::copy_n(found.six.begin(), 3, six->deviations[i].shift.begin());
        std::copy_n(found.six.begin() + 3, 3, six->deviations[i].turn.begin());
    }
}

/// What calibration finds is small. Anything else is a unit that was mistaken, or another arm.
void check_deviations(Reader& reader, const axes::Kinematics& arm, const ArmEntry& written, const std::string& unit,
                      const std::string& here) {
    constexpr double most_share = 0.02, most_turn = 5;  // of the arm's links in all; deg
    constexpr double degrees = 180 / std::numbers::pi;
    if (!arm.rows()) return;  // told already
    double links = 0;
    for (const auto& row : arm.rows()->rows) links += std::abs(row.a) + std::abs(row.d);
    for (const auto& found : written.deviations) {
        double shift = 0, turn = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            shift = std::max(shift, std::abs(found.six[i]));
            turn = std::max(turn, std::abs(found.six[i + 3]) * degrees);
        }
        if (shift <= most_share * links && turn <= most_turn) continue;
        const auto key = here + ".deviations." + found.axis;
        const bool by_length = shift > most_share * links;
        reader.problem_in(key, "config.group_arm",
                          "`" + key + "` is " + (by_length ? show_number(shift) + " " + unit : show_number(turn) + " deg") +
                              ", and a link differs by a fiftieth of the arm or 5 deg at most from the written one",
                          "compare its units with the calibration's, or write the arm as it is");
    }
}

/// The key of kinematics that an error of Kinematics::make is about: "scara.second", "joints", or the arm's.
std::string key_of(const axes::ArmDescription& arm, const Error& why) {
    if (why.code == "kinematics.coupling") return "joints";
    const std::string kind{kind_of(arm)};
    const auto* six = std::get_if<axes::SixJoints>(&arm);
    const bool by_table = six != nullptr && std::holds_alternative<axes::SixJoints::Table>(six->geometry);
    const std::string key = six == nullptr ? kind : by_table ? "dh" : "wrist";
    return why.subject.compare(0, kind.size() + 1, kind + ".") == 0 ? key + why.subject.substr(kind.size()) : key;
}

bool is_angle(std::string_view unit) { return parse_quantity("1 rad", Dimension::position, unit).problem == QuantityProblem::none; }

void check_setup_velocity(Reader& reader, const Node& node, const GroupEntry& entry) {
    const auto* written = node.find("setup_velocity");
    if (written == nullptr) return;
    const auto most = parse_quantity("250 mm/s", Dimension::velocity, entry.unit);
    const double velocity = entry.group.setup_velocity;
    if (parse_quantity(written->text, Dimension::velocity, entry.unit).problem != QuantityProblem::none) return;  // told already
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
        if (node.kind == Node::Kind::scalar && report_arm_word(reader, node)) return false;
        const auto kept = reader.axis_unit;
        const bool good = read(reader, node, entry);
        reader.axis_unit = kept;
        return good;
    };
    f.push_back(field_via<G>(
        "kinematics", std::move(arm), [](G& g, const ArmEntry& written) { g.arm = std::make_shared<const ArmEntry>(written); },
        "the arm that they are", "none: ACS alone"));
    for (auto& equipment : equipment_fields()) f.push_back(std::move(equipment));
    for (auto& watched : workspace_fields()) f.push_back(std::move(watched));
    table.instead = {{"axes", "`members` names them, such as `members: [x, y]`"}};
    for (const char* key : {"base", "joints", "deviations"}) table.instead.emplace_back(key, "it is a key of `kinematics`: move it there");
    for (const char* key : {"velocity", "acceleration", "deceleration", "jerk"})
        table.instead.emplace_back(key, "it is a key of `default`: move it there");
    table.instead.emplace_back("limits", "each axis has limits of its own; how fast it goes where a command does not say it is `default`");
    table.before = [](Reader& reader, const Node& node, G& g) {
        const auto* unit = node.find("unit");
        const auto& known = axis_units();
        reader.axis_unit = unit != nullptr && std::find(known.begin(), known.end(), unit->text) != known.end() ? unit->text : g.unit;
        if (unit != nullptr && node.find("kinematics") != nullptr && is_angle(reader.axis_unit)) {
            reader.problem(unit->at, "config.group_unit",
                           "group " + g.group.name + " has an arm, whose lengths and paths are not in " + reader.axis_unit,
                           "write a unit of length, such as mm; its joints count in the units of their axes");
            reader.axis_unit = GroupEntry{}.unit;  // so that its lengths are not accused
        }
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
    count_joints(description, group, written, entry.unit, units);
    deviate(reader, description, group, written, here);
    auto made = axes::Kinematics::make(description);
    if (!made.ok()) {
        const auto& why = made.error();
        const auto key = here + "." + key_of(description.arm, why);
        const bool coupled = why.code == "kinematics.coupling";
        reader.problem_in(key, why.code,
                          "`" + key + "`: " + (coupled ? "by `moved_by` the motors do not say where the joints are" : why.what),
                          coupled ? "compare the ratios with the maker's, and which motor goes with which joint" : why.remedy);
        return group;
    }
    group.kinematics = std::make_shared<const axes::Kinematics>(made.value());
    check_deviations(reader, made.value(), written, entry.unit, here);
    const auto& rotary = group.kinematics->rotary();
    if (group.members.size() != group.kinematics->joint_count()) return group;  // told as that, and which is missing nobody knows
    for (std::size_t i = 0; i < group.members.size(); ++i) {
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

void check_travel(Reader& reader, const GroupEntry& entry, const std::vector<runtime::AxisBinding>& axes) {
    if (!entry.arm) return;
    for (const auto& joint : entry.arm->joints) {
        const auto binding = std::find_if(axes.begin(), axes.end(), [&](const auto& one) { return one.axis.name == joint.axis; });
        if (!joint.limits || !joint.moved_by.empty() || binding == axes.end()) continue;
        const auto& limits = binding->axis.limits;
        if (joint.limits->first <= limits.position_max && joint.limits->second >= limits.position_min) continue;
        const auto key = "groups." + entry.group.name + ".kinematics.joints." + joint.axis + ".limits";
        reader.problem_in(key, "config.group_joint",
                          "`" + key + "` and the software limits of axis " + joint.axis + " leave no place to the joint",
                          "compare both: they are counted alike, in " + reader.units_of_axes[joint.axis]);
    }
}

}  // namespace taktwerk::config
