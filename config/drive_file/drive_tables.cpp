#include "config/drive_file/drive_tables.hpp"

#include <fmt/format.h>

#include "config/drive_file/device_tables.hpp"
#include "config/drive_file/drive_alarm_tables.hpp"
#include "config/drive_file/drive_motion_tables.hpp"
#include "config/drive_file/mapping_check.hpp"
#include "config/drive_file/setting_tables.hpp"
#include "config/reading/codecs.hpp"

namespace taktwerk::config {

namespace {

using ecat::DeviceDescription;

/// Objects below belong to the communication, not to an axis.
constexpr std::uint16_t first_axis_object = 0x2000;

Table<PdoChoice> choice_table() {
    using P = PdoChoice;
    return {"mapping.<direction>",
            "A PDO that the runtime assigns.",
            {
                required(field("pdo", &P::pdo, object_address(), "one of the available PDOs")),
                with_default(field("objects", &P::objects, list(pdo_entry()), "what is mapped into it"), "as the drive has it"),
                field("required", &P::required, list(pdo_entry()),
                      "of a drive whose process data is assumed: what it must take, while the rest of `objects` is a wish, best first"),
            },
            {},
            {}};
}

Table<DriveFile> mapping_table() {
    using F = DriveFile;
    return {"mapping",
            "What the runtime assigns and maps, unless a machine asks for something else.",
            {required(field("rx", &F::rx, list(section(choice_table())), "to the drive")),
             required(field("tx", &F::tx, list(section(choice_table())), "from the drive")),
             with_default(field("module", &F::module, name(), "of a modular drive: what is put into every slot"), "none")},
            {},
            {}};
}

Table<axes::DriveOrderObject> order_table() {
    using O = axes::DriveOrderObject;
    using D = axes::DriveOrder;
    return {"orders",
            "A parameter that is a command.",
            {
                required(field("order", &O::order,
                               choice<D>({{"emergency_stop", D::emergency_stop},
                                          {"reset_alarm", D::reset_alarm},
                                          {"save_parameters", D::save_parameters},
                                          {"restore_parameters", D::restore_parameters}}),
                               "what the drive does (axes/port/drive_profile.hpp)")),
                required(field("object", &O::address, parameter_address(), "that is written")),
                field("value", &O::value, integer<std::int64_t>(0, u32), "that gives the order"),
            },
            {},
            {}};
}

}  // namespace

Codec<std::int64_t> version_number() {
    auto c = integer<std::int64_t>(0, 1'000'000);
    c.shape.minimum = c.shape.maximum = static_cast<double>(format_version);
    c.read = [number = c.read](Reader& reader, const Node& node, std::int64_t& out) {
        if (!number(reader, node, out)) return false;
        if (out == format_version) return true;
        reader.problem(node.at, "config.version",
                       fmt::format("the file has format version {}, this program reads version {}", out, format_version),
                       out > format_version ? "use a newer taktwerk" : "write `version: 1`");
        return false;
    };
    return c;
}

namespace {

Table<axes::DriveAssumption> assumption_table() {
    using A = axes::DriveAssumption;
    using P = axes::AssumedPart;
    return {"assumptions",
            "What is taken for granted of a drive that nobody described; `taktwerk check` tells.",
            {
                field("part", &A::part,
                      choice<P>({{"other", P::other},
                                 {"identity", P::identity},
                                 {"controller", P::controller},
                                 {"process_data", P::process_data},
                                 {"modes", P::modes}}),
                      "where the drive's own word goes before this file's (axes/port/drive_assumption.hpp)"),
                required(field("text", &A::text, text(), "what is assumed")),
                required(field("why", &A::why, text(), "where that comes from")),
                required(field("otherwise", &A::otherwise, text(), "what to write where it is not so")),
                field("unless", &A::unless, list(text()), "keys of a drive file based on this one, or of the slave, that state it"),
            },
            {},
            {}};
}

/// Who it is: the first lines of every drive file.
void add_identity_fields(std::vector<Field<DriveFile>>& f) {
    using F = DriveFile;
    f.push_back(version_field(&F::version));
    f.push_back(with_default(
        field("based_on", &F::based_on, config::name(), "another drive file, which holds for all that this one does not say"), "none"));
    f.push_back(required(field_at<F>(
        "name", [](F & d) -> auto& { return d.profile.name; }, name(), "as machines name it: `profile: sv33-e`")));
    f.push_back(required(field_at<F>(
        "vendor", [](F & d) -> auto& { return d.profile.vendor; }, text(), "for people")));
    f.push_back(required(field_at<F>(
        "title", [](F & d) -> auto& { return d.profile.title; }, text(), "for people")));
}

/// How far it may be trusted, where no manual was at hand: the words of device files.
void add_source_fields(std::vector<Field<DriveFile>>& f) {
    using F = DriveFile;
    f.push_back(with_default(field("source", &F::source, text(), "where these facts come from"), "the manual that its head names"));
    f.push_back(with_default(field("checked", &F::checked, checked_against(), checked_doc), "the manual"));
}

/// What it means to an axis and to people, whatever carries it.
void add_profile_fields(std::vector<Field<DriveFile>>& f) {
    using F = DriveFile;
    f.push_back(required(field("motion", &F::profile, section(motion_table()), "what it means to an axis")));
    f.push_back(field_at<F>(
        "quirks", [](F & d) -> auto& { return d.profile.quirks; }, list(quirk()),
        "deviations from CiA 402, by name (axes/port/quirk.hpp)"));
    f.push_back(field_at<F>(
        "stops", [](F & d) -> auto& { return d.profile.stops.options; }, list(section(stop_option_table())),
        "how it stops by itself, as far as the manual documents options; they go before `off_stop`, `fault_stop`, `quick_stop_leaves`"));
    f.push_back(field_at<F>(
        "emergency_torque", [](F & d) -> auto& { return d.profile.stops.emergency_torque; }, parameter_address(),
        "object with the torque of stops by emergency_torque"));
    f.push_back(field_at<F>(
        "alarms", [](F & d) -> auto& { return d.profile.alarms; }, list(section(alarm_row_table())), "the drive's alarms"));
    f.push_back(field("alarm_file", &F::alarm_file, text(), "file beside this one with the alarms, where they are many"));
    f.push_back(field_at<F>(
        "alarm_history", [](F & d) -> auto& { return d.profile.alarm_history; }, section(alarm_history_table()),
        "where the drive shows its earlier alarms"));
    f.push_back(field_at<F>(
        "limits_switch", [](F & d) -> auto& { return d.profile.limits_switch; }, parameter_address(),
        "object that switches the drive's software limits: 0 off, 1 on, 2 on after homing"));
    f.push_back(field_at<F>(
        "orders", [](F & d) -> auto& { return d.profile.orders; }, list(section(order_table())), "parameters that are commands"));
    f.push_back(field_at<F>(
        "hazards", [](F & d) -> auto& { return d.profile.hazards; }, list(section(hazard_table())),
        "what is dangerous about it; `taktwerk check` warns of it"));
    f.push_back(field_at<F>(
        "required_settings", [](F & d) -> auto& { return d.profile.required_settings; }, list(section(required_setting_table())),
        "objects without whose value the drive must not be enabled"));
    f.push_back(field_at<F>(
        "units", [](F & d) -> auto& { return d.profile.units; }, section(units_table()), "an object that chooses the drive's units"));
    f.push_back(field_at<F>(
        "scale", [](F & d) -> auto& { return d.profile.scale; }, section(scale_table()), "counts of a turn of its motor"));
    f.push_back(field_at<F>(
        "behaviour", [](F & d) -> auto& { return d.profile.behaviour; }, section(behaviour_table()),
        "objects that the simulated drive obeys"));
    f.push_back(field_at<F>(
        "storage", [](F & d) -> auto& { return d.profile.storage.way; },
        choice<axes::ParameterStorage>({{"not_stated", axes::ParameterStorage::not_stated},
                                        {"each_write", axes::ParameterStorage::each_write},
                                        {"on_request", axes::ParameterStorage::on_request},
                                        {"never", axes::ParameterStorage::never}}),
        "how parameters get into its EEPROM"));
    f.push_back(field_at<F>(
        "storage_switch", [](F & d) -> auto& { return d.profile.storage.switched_by; }, parameter_address(),
        "while this object is 0 writes are not stored"));
    f.push_back(field_at<F>(
        "questions", [](F & d) -> auto& { return d.profile.questions; }, list(text()), "what only the vendor or a real drive can answer"));
    f.push_back(field_at<F>(
        "assumed", [](F & d) -> auto& { return d.profile.assumed; }, list(text()),
        "what the manual leaves open and this file took, in words"));
    f.push_back(field_at<F>(
        "assumptions", [](F & d) -> auto& { return d.profile.assumptions; }, list(section(assumption_table())),
        "of a drive that nobody described: what is taken for granted, and how a machine says otherwise"));
}

}  // namespace

Table<DriveFile> drive_table() {
    using F = DriveFile;
    const auto device = [](F& f) -> DeviceDescription& { return f.device; };
    Table<F> table{"drive file", "What one drive type is (for master and simulator) and what it means to an axis.", {}, {}, {}};
    auto& f = table.fields;
    add_identity_fields(f);
    add_source_fields(f);
    include_fields(f, device, Table<DeviceDescription>{{}, {}, device_fields(), {}, {}});
    f.push_back(required(field("objects", &F::objects, list(section(object_table())),
                               "of the dictionary: all that is mapped or that the runtime writes; the others may stand in `object_file`")));
    f.push_back(field("object_file", &F::object_file, text(), "file beside this one with the other objects, where they are many"));
    f.push_back(required(field_at<F>(
        "mapping", [](F& d) -> F& { return d; }, section(mapping_table()), "what the runtime maps")));
    f.push_back(
        field("startup", &F::startup, list(section(startup_table())), "SDOs written on every bring-up, before those of the machine"));
    add_profile_fields(f);
    table.after = [](Reader& reader, const Node&, F& file) {
        add_objects(file, file.objects);
        check_mapping(reader, file);
    };
    return table;
}

Table<DriveFile> serial_drive_table() {
    using F = DriveFile;
    Table<F> table{"serial drive file",
                   "A drive type on a serial line: it has parameters and alarms, but no dictionary and no process data.",
                   {},
                   {},
                   {}};
    auto& f = table.fields;
    add_identity_fields(f);
    f.push_back(required(field("carried_by", &F::carrier, choice<SerialCarrier>({{"xp200_modbus", SerialCarrier::xp200_modbus}}),
                               "how it is reached: Modbus RTU as the XP200 speaks it")));
    f.push_back(field("objects", &F::objects, list(section(object_table())), "its parameters, each by its `register`"));
    f.push_back(field("object_file", &F::object_file, text(), "file beside this one with the parameters, where they are many"));
    add_profile_fields(f);
    table.after = [](Reader&, const Node&, F& file) { add_objects(file, file.objects); };
    return table;
}

void add_objects(DriveFile& file, const std::vector<ObjectRow>& rows) {
    for (const auto& row : rows) {
        file.profile.parameters.push_back(row.parameter);
        if (!row.is_object()) continue;
        file.device.objects.push_back(row.object);
        if (row.object.index < first_axis_object) continue;
        for (unsigned axis = 1; axis < file.profile.axes; ++axis) {
            auto further = row.object;
            further.index = static_cast<std::uint16_t>(further.index + axis * file.profile.object_offset);
            file.device.objects.push_back(std::move(further));
        }
    }
}

Table<ObjectFile> object_file_table() {
    using O = ObjectFile;
    return {"object file",
            "Objects and parameters of one drive type.",
            {version_field(&O::version), required(field("objects", &O::objects, list(section(object_table())), "as in the drive file"))},
            {},
            {}};
}

Table<AlarmFile> alarm_table() {
    using A = AlarmFile;
    return {"alarm file",
            "The alarms of one drive type.",
            {version_field(&A::version), required(field("alarms", &A::alarms, list(section(alarm_row_table())), "the drive's alarms"))},
            {},
            {}};
}

}  // namespace taktwerk::config
