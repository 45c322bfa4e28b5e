#include "config/drive_tables.hpp"

#include <limits>

#include <fmt/format.h>

#include "axes/port/quirk_table.hpp"
#include "config/codecs.hpp"
#include "config/device_tables.hpp"
#include "config/setting_tables.hpp"

namespace taktwerk::config {

namespace {

using axes::DriveAlarmText;
using axes::DriveMode;
using axes::DriveProfile;
using axes::Quirk;
using ecat::DeviceDescription;
using ecat::Mappable;

constexpr std::int64_t u16 = 0xFFFF, u32 = 0xFFFFFFFF;
/// Objects below belong to the communication, not to an axis.
constexpr std::uint16_t first_axis_object = 0x2000;

Table<PdoChoice> choice_table() {
    using P = PdoChoice;
    return {"mapping.<direction>",
            "A PDO that the runtime assigns.",
            {
                required(field("pdo", &P::pdo, object_address(), "one of the available PDOs")),
                with_default(field("objects", &P::objects, list(pdo_entry()), "what is mapped into it"), "as the drive has it"),
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

Codec<axes::DriveStop> drive_stop() {
    return choice<axes::DriveStop>({{"coast", axes::DriveStop::coast}, {"ramp", axes::DriveStop::ramp}});
}

Codec<axes::DriveAlarmKind> alarm_kind() {
    using K = axes::DriveAlarmKind;
    return choice<K>({{"other", K::other},
                      {"overspeed", K::overspeed},
                      {"following_error", K::following_error},
                      {"setpoint_leap", K::setpoint_leap},
                      {"undervoltage", K::undervoltage},
                      {"overload", K::overload},
                      {"encoder", K::encoder},
                      {"communication", K::communication},
                      {"sync_lost", K::sync_lost},
                      {"negative_limit", K::negative_limit},
                      {"positive_limit", K::positive_limit},
                      {"emergency_stop", K::emergency_stop},
                      {"battery_low", K::battery_low},
                      {"reference_lost", K::reference_lost},
                      {"turn_overflow", K::turn_overflow},
                      {"homing_timeout", K::homing_timeout},
                      {"homing_limit", K::homing_limit},
                      {"homing_method", K::homing_method},
                      {"power_cycle_pending", K::power_cycle_pending},
                      {"mode_not_set", K::mode_not_set},
                      {"mode_change", K::mode_change},
                      {"left_operational", K::left_operational},
                      {"link_changed", K::link_changed},
                      {"torque_overload", K::torque_overload},
                      {"parameter_storage", K::parameter_storage},
                      {"cycle_setting", K::cycle_setting},
                      {"limits_crossed", K::limits_crossed},
                      {"home_outside_limits", K::home_outside_limits},
                      {"start_too_fast", K::start_too_fast},
                      {"enabled_twice", K::enabled_twice},
                      {"phase_lost", K::phase_lost},
                      {"safe_torque_off", K::safe_torque_off},
                      {"stall", K::stall},
                      {"overvoltage", K::overvoltage}});
}

Codec<DriveMode> drive_mode() {
    return choice<DriveMode>({{"pp", DriveMode::profile_position},
                              {"pv", DriveMode::profile_velocity},
                              {"pt", DriveMode::profile_torque},
                              {"hm", DriveMode::homing},
                              {"csp", DriveMode::cyclic_position},
                              {"csv", DriveMode::cyclic_velocity},
                              {"cst", DriveMode::cyclic_torque}});
}

Codec<Quirk> quirk() {
    std::vector<std::pair<std::string, Quirk>> names;
    for (const auto& row : axes::quirk_table) names.emplace_back(row.name, row.quirk);
    return choice<Quirk>(std::move(names));
}

Table<axes::DriveHazard> hazard_table() {
    using H = axes::DriveHazard;
    using C = axes::HazardCondition;
    return {"hazards",
            "What is dangerous about the drive in a machine that forgot something; `taktwerk check` warns of it.",
            {
                required(field("when", &H::when,
                               choice<C>({{"always", C::always},
                                          {"not_written", C::not_written},
                                          {"not_set_to", C::not_set_to},
                                          {"set_to", C::set_to},
                                          {"mapped", C::mapped},
                                          {"not_mapped", C::not_mapped},
                                          {"mode_mapped", C::mode_mapped},
                                          {"homed_by_drive", C::homed_by_drive},
                                          {"no_software_limits", C::no_software_limits},
                                          {"absolute_homing", C::absolute_homing}}),
                               "what makes it a hazard of this machine (axes/port/drive_hazard.hpp)")),
                field("objects", &H::objects, list(parameter_address()), "that the condition looks at"),
                field("values", &H::values,
                      list(integer<std::int64_t>(std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max())),
                      "that the condition compares with"),
                field("mode", &H::mode, drive_mode(), "that the condition looks at"),
                required(field("text", &H::text, text(), "what happens, in one sentence")),
                field("remedy", &H::remedy, text(), "what to write or wire"),
                required(field("section", &H::section, text(), "of the manual")),
            },
            {},
            {}};
}

Table<axes::StopWay> stop_way_table() {
    using W = axes::StopWay;
    using B = axes::StopBy;
    using T = axes::StopThen;
    return {
        "stops.ways",
        "One value of a stop option.",
        {
            field("value", &W::value, integer<std::int16_t>(-32768, 32767), "of the option's object"),
            with_default(field("modes", &W::modes, list(drive_mode()), "in which it means that; the first row that fits counts"), "all"),
            required(field("by", &W::by,
                           choice<B>({{"coast", B::coast},
                                      {"dynamic_brake", B::dynamic_brake},
                                      {"ramp", B::ramp},
                                      {"quick_ramp", B::quick_ramp},
                                      {"torque_slope", B::torque_slope},
                                      {"emergency_torque", B::emergency_torque},
                                      {"zero_speed", B::zero_speed}}),
                           "how the motor is slowed down (axes/port/drive_stop.hpp)")),
            required(field("then", &W::then,
                           choice<T>({{"free", T::free}, {"lock", T::lock}, {"clamp", T::clamp}, {"dynamic_brake", T::dynamic_brake}}),
                           "what holds it afterwards")),
        },
        {},
        {}};
}

Table<axes::StopOption> stop_option_table() {
    using O = axes::StopOption;
    using S = axes::StopCause;
    return {"stops",
            "How the drive stops by itself for one cause.",
            {
                required(field("cause", &O::cause,
                               choice<S>({{"quick_stop", S::quick_stop},
                                          {"off", S::off},
                                          {"shutdown", S::shutdown},
                                          {"disable", S::disable},
                                          {"halt", S::halt},
                                          {"fault", S::fault},
                                          {"overtravel", S::overtravel}}),
                               "what makes it stop")),
                with_default(field("object", &O::object, parameter_address(), "that chooses the way"), "the only row counts"),
                required(field("ways", &O::ways, list(section(stop_way_table())), "what the manual says of each value")),
            },
            {},
            {}};
}

Table<DriveProfile> motion_table() {
    using P = DriveProfile;
    return {
        "motion",
        "What the drive means to an axis.",
        {
            required(field("modes", &P::modes, list(drive_mode()), "modes of operation that we use of it (6060h)")),
            field("homing_methods", &P::homing_methods, list(integer<std::int8_t>(-128, 127)), "6098h values that the manual documents"),
            field("velocity_counts_per_unit", &P::velocity_counts_per_unit, number(), "606Ch and 60FFh raw = counts/s times this"),
            field("torque_rated_raw", &P::torque_rated_raw, number(), "6077h and 6071h raw value of rated torque"),
            field("position_bits", &P::position_bits, integer<std::uint8_t>(8, 64), "width of the raw position"),
            with_default(field("homing_timeout", &P::homing_timeout, parameter_address(), "object that bounds the drive\'s own homing"),
                         "none"),
            field("homing_timeout_unit", &P::homing_timeout_unit, duration(), "of that object"),
            field("encoder_turn_bits", &P::encoder_turn_bits, integer<std::uint8_t>(0, 32),
                  "width of an absolute encoder's turn counter; 0: not stated"),
            with_default(field("clear_turns", &P::clear_turns, parameter_address(), "object that makes the encoder forget its turns"),
                         "none"),
            field("clear_turns_value", &P::clear_turns_value, integer<std::int64_t>(0, 65535), "written to that object"),
            field("clear_turns_control", &P::clear_turns_control, integer<std::uint16_t>(0, 0xFFFF),
                  "bits of 6040h that make the encoder forget its turns"),
            with_default(field("encoder_reset", &P::encoder_reset, parameter_address(),
                               "object: 1 ends the encoder's fault and its turns, seen at the next power-on"),
                         "none"),
            field("battery_low", &P::battery_low, number(), "V of the encoder's battery below which the drive warns; 0: not stated"),
            field("battery_empty", &P::battery_empty, number(), "V below which the turns are lost at power-off; 0: not stated"),
            field("probes", &P::probes, integer<std::uint8_t>(0, 2), "touch probes"),
            field("motor_has_encoder", &P::motor_has_encoder, boolean(), "false: the actual position is the command"),
            with_default(
                field("minimum_cycle_csp", &P::minimum_cycle_csp, duration(), "shortest cycle in cyclic synchronous position mode"),
                "not stated"),
            with_default(
                field("minimum_cycle_csv", &P::minimum_cycle_csv, duration(), "shortest cycle in cyclic synchronous velocity mode"),
                "not stated"),
            with_default(field("minimum_cycle_cst", &P::minimum_cycle_cst, duration(), "shortest cycle in cyclic synchronous torque mode"),
                         "not stated"),
            field("enable_delay", &P::enable_delay, duration(), "motion waits this long after enabling (brake)"),
            field("mode_change_delay", &P::mode_change_delay, duration(), "set-points wait this long after a mode change"),
            field("enable_timeout", &P::enable_timeout, duration(), "enabling that takes longer has failed"),
            field("mode_change_at_standstill", &P::mode_change_at_standstill, boolean(), "modes change only while it stands"),
            field("mode_change_interval", &P::mode_change_interval, duration(), "least time between two changes of 6060h"),
            field("mode_indeterminate", &P::mode_indeterminate, duration(), "6061h means nothing this long after a change of 6060h"),
            field("mode_violation", &P::mode_violation,
                  choice<axes::ModeViolation>({{"obeyed", axes::ModeViolation::obeyed},
                                               {"ignored", axes::ModeViolation::ignored},
                                               {"alarm", axes::ModeViolation::alarm}}),
                  "what a change of mode leads to that comes too soon or in motion"),
            field("profile_buffer", &P::profile_buffer, integer<std::uint8_t>(1, 64), "set-points that PP takes behind the running one"),
            field("enable_status_bits", &P::enable_status_bits, integer<std::uint16_t>(0, u16),
                  "of 6041h, all set before Enable Operation"),
            field("brake_release", &P::brake_release, duration(), "after enabling the brake still holds: the drive loses earlier commands"),
            field("brake_hold", &P::brake_hold, duration(), "after disabling at standstill the motor holds until the brake does"),
            field("brake_moving_wait", &P::brake_moving_wait, duration(),
                  "power gone in motion: the brake closes after this at the latest"),
            field("brake_moving_speed", &P::brake_moving_speed, number(), "rpm below which it closes at once"),
            field("self_test", &P::self_test, duration(), "Not Ready To Switch On lasts this long after power-on"),
            field("deaf_after_enable", &P::deaf_after_enable, duration(), "set-points are not obeyed this long after enabling"),
            field("missed_frames_allowed", &P::missed_frames_allowed, integer<std::uint8_t>(0, 255),
                  "in a row in OP, one more is its communication alarm; 0: not counted"),
            field("overspeed_limit", &P::overspeed_limit, number(), "of the motor's maximum speed, beyond it an alarm; 0: none"),
            field("torque_overload", &P::torque_overload, number(), "rated torques, for longer than `torque_overload_time` an alarm"),
            field("torque_overload_time", &P::torque_overload_time, duration(), "how long more torque than `torque_overload` is allowed"),
            field("off_stop", &P::off_stop, drive_stop(), "power taken away while it moves"),
            field("fault_stop", &P::fault_stop, drive_stop(), "its reaction to a fault"),
            field("quick_stop_leaves", &P::quick_stop_leaves, boolean(), "Quick Stop Active ends by itself"),
            field("csp_interpolates", &P::csp_interpolates, boolean(), "a target is reached one cycle after the SYNC0 that brought it"),
            field("axes", &P::axes, integer<std::uint8_t>(1, 8), "axes in this drive"),
            field("object_offset", &P::object_offset, integer<std::uint16_t>(0, u16), "of the objects of each further axis"),
            field("pdo_offset", &P::pdo_offset, integer<std::uint16_t>(0, u16), "of the PDOs of each further axis"),
            field("input_bit_negative_limit", &P::input_bit_negative_limit, integer<std::uint8_t>(0, 31), "in 60FDh"),
            field("input_bit_positive_limit", &P::input_bit_positive_limit, integer<std::uint8_t>(0, 31), "in 60FDh"),
            field("input_bit_home", &P::input_bit_home, integer<std::uint8_t>(0, 31), "in 60FDh"),
            field_via<P>(
                "alarm_detail", object_address(),
                [](P& p, const ObjectAddress& a) { p.alarm_detail_index = a.index, p.alarm_detail_sub = a.sub; },
                "object that tells alarms apart which share a 603Fh code", "none"),
        },
        {},
        {}};
}

Table<DriveAlarmText> alarm_row_table() {
    using A = DriveAlarmText;
    return {"alarms",
            "One alarm of the drive.",
            {
                required(field("code", &A::code, integer<std::uint16_t>(1, u16), "603Fh")),
                with_default(field("detail", &A::detail, integer<std::uint32_t>(0, u32), "value of the detail object"), "the code alone"),
                field("panel", &A::panel, text(), "what the drive's own display shows"),
                required(field("english", &A::english, text(), "its name in English")),
                required(field("chinese", &A::chinese, text(), "its name in Chinese, as the manual prints it")),
                field("cause", &A::cause, text(), "why it comes"),
                field("remedy", &A::remedy, text(), "what to do"),
                field("resettable", &A::resettable, boolean(), "false: only a power cycle clears it"),
                field("clears_itself", &A::clears_itself, boolean(), "with its cause, without a reset"),
                field("warning", &A::warning, boolean(), "the drive goes on"),
                field("whole_drive", &A::whole_drive, boolean(), "common to all axes of the drive"),
                field("kind", &A::kind, alarm_kind(), "what it means, whatever its number"),
                field("section", &A::section, text(), "of the manual"),
            },
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

Table<axes::AlarmHistoryObjects> history_table() {
    using H = axes::AlarmHistoryObjects;
    return {"alarm_history",
            "Where the drive shows its earlier alarms.",
            {
                required(field("select", &H::select, parameter_address(), "0 the present alarm, 1 the latest before it, and so on")),
                required(field("code", &H::code, parameter_address(), "as the object of `alarm_detail` shows it")),
                field("time", &H::time, parameter_address(), "since power-on, 0.1 s"),
                field("speed", &H::speed, parameter_address(), "of the motor at that time, rpm"),
            },
            {},
            {}};
}

/// Fills in the bits of mapped objects and reports objects that the dictionary lacks or that may not be mapped.
class PdoResolver {
public:
    PdoResolver(Reader& reader, const DeviceDescription& device) : reader_(reader), device_(device) {}

    void resolve(ecat::PdoEntry& entry, bool rx, std::string_view place) const {
        if (entry.index == 0) return;  // a gap
        const auto* object = find_object(device_, entry.index, entry.sub);
        const auto shown = show_object(entry.index, entry.sub);
        if (!object) {
            report(place, fmt::format("{} is mapped, but `objects` does not list it", shown), "add it to `objects` with its type");
            return;
        }
        if (entry.bits == 0) entry.bits = ecat::bit_size(object->type);
        if (object->mappable != Mappable::both && object->mappable != (rx ? Mappable::rx : Mappable::tx))
            report(place, fmt::format("{} cannot be mapped into {}", shown, rx ? "an RxPDO" : "a TxPDO"),
                   fmt::format("remove it, or correct its `map:` in `objects`"));
    }

    void report(std::string_view place, std::string what, std::string remedy) const {
        reader_.problem(reader_.find(place), "config.mapping", std::move(what), std::move(remedy));
    }

private:
    Reader& reader_;
    const DeviceDescription& device_;
};

void check_rules(const PdoResolver& resolver, const std::vector<PdoChoice>& chosen, const std::vector<ecat::PdoDescription>& available,
                 const ecat::PdoRules& rules, std::string_view place) {
    std::size_t bits = 0;
    if (chosen.size() > rules.max_assigned)
        resolver.report(place, fmt::format("{} PDOs are assigned, the drive takes {}", chosen.size(), rules.max_assigned), "use fewer");
    for (const auto& choice : chosen) {
        const ecat::PdoDescription* pdo = nullptr;
        for (const auto& a : available)
            if (a.index == choice.pdo.index) pdo = &a;
        if (!pdo) {
            resolver.report(place, fmt::format("PDO {:04X}h is not among those `available`", choice.pdo.index), "correct its number");
            continue;
        }
        if (pdo->fixed && !choice.objects.empty())
            resolver.report(place, fmt::format("PDO {:04X}h is fixed", choice.pdo.index), "remove its `objects`");
        const auto& entries = choice.objects.empty() ? pdo->entries : choice.objects;
        if (entries.size() > rules.max_entries)
            resolver.report(
                place, fmt::format("PDO {:04X}h maps {} objects, the drive takes {}", choice.pdo.index, entries.size(), rules.max_entries),
                "map fewer");
        for (const auto& e : entries) bits += e.bits;
    }
    if ((bits + 7) / 8 > rules.max_bytes)
        resolver.report(place, fmt::format("{} bytes are mapped, the drive takes {}", (bits + 7) / 8, rules.max_bytes),
                        "map fewer objects");
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

/// Who it is: the first lines of every drive file.
void add_identity_fields(std::vector<Field<DriveFile>>& f) {
    using F = DriveFile;
    f.push_back(version_field(&F::version));
    f.push_back(required(field_at<F>(
        "name", [](F & d) -> auto& { return d.profile.name; }, name(), "as machines name it: `profile: sv33-e`")));
    f.push_back(required(field_at<F>(
        "vendor", [](F & d) -> auto& { return d.profile.vendor; }, text(), "for people")));
    f.push_back(required(field_at<F>(
        "title", [](F & d) -> auto& { return d.profile.title; }, text(), "for people")));
}

/// What it means to an axis and to people, whatever carries it.
void add_profile_fields(std::vector<Field<DriveFile>>& f) {
    using F = DriveFile;
    f.push_back(required(field("motion", &F::profile, section(motion_table()), "what it means to an axis")));
    f.push_back(field_at<F>(
        "quirks", [](F & d) -> auto& { return d.profile.quirks; }, list(quirk()),
        "deviations from CiA 402, by name (axes/port/quirk_table.hpp)"));
    f.push_back(field_at<F>(
        "stops", [](F & d) -> auto& { return d.profile.stops; }, list(section(stop_option_table())),
        "how it stops by itself, as far as the manual documents options; they go before `off_stop`, `fault_stop`, `quick_stop_leaves`"));
    f.push_back(field_at<F>(
        "emergency_torque", [](F & d) -> auto& { return d.profile.emergency_torque; }, parameter_address(),
        "object with the torque of stops by emergency_torque"));
    f.push_back(field_at<F>(
        "alarms", [](F & d) -> auto& { return d.profile.alarms; }, list(section(alarm_row_table())), "the drive's alarms"));
    f.push_back(field("alarm_file", &F::alarm_file, text(), "file beside this one with the alarms, where they are many"));
    f.push_back(field_at<F>(
        "alarm_history", [](F & d) -> auto& { return d.profile.alarm_history; }, section(history_table()),
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
        "behaviour", [](F & d) -> auto& { return d.profile.behaviour; }, section(behaviour_table()),
        "objects that the simulated drive obeys"));
    f.push_back(field_at<F>(
        "storage", [](F & d) -> auto& { return d.profile.storage; },
        choice<axes::ParameterStorage>({{"not_stated", axes::ParameterStorage::not_stated},
                                        {"each_write", axes::ParameterStorage::each_write},
                                        {"on_request", axes::ParameterStorage::on_request},
                                        {"never", axes::ParameterStorage::never}}),
        "how parameters get into its EEPROM"));
    f.push_back(field_at<F>(
        "storage_switch", [](F & d) -> auto& { return d.profile.storage_switch; }, parameter_address(),
        "while this object is 0 writes are not stored"));
    f.push_back(field_at<F>(
        "questions", [](F & d) -> auto& { return d.profile.questions; }, list(text()), "what only the vendor or a real drive can answer"));
    f.push_back(field_at<F>(
        "assumed", [](F & d) -> auto& { return d.profile.assumed; }, list(text()),
        "what the manual leaves open and this file took, in words"));
}

}  // namespace

Table<DriveFile> drive_table() {
    using F = DriveFile;
    const auto device = [](F& f) -> DeviceDescription& { return f.device; };
    Table<F> table{"drive file", "What one drive type is (for master and simulator) and what it means to an axis.", {}, {}, {}};
    auto& f = table.fields;
    add_identity_fields(f);
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
        const PdoResolver resolver(reader, file.device);
        for (auto& pdo : file.device.rx_pdos)
            for (auto& entry : pdo.entries) resolver.resolve(entry, true, "pdo.rx");
        for (auto& pdo : file.device.tx_pdos)
            for (auto& entry : pdo.entries) resolver.resolve(entry, false, "pdo.tx");
        for (auto& module : file.device.slots.modules) {
            for (auto& pdo : module.rx_pdos)
                for (auto& entry : pdo.entries) resolver.resolve(entry, true, "slots.modules");
            for (auto& pdo : module.tx_pdos)
                for (auto& entry : pdo.entries) resolver.resolve(entry, false, "slots.modules");
        }
        for (auto& choice : file.rx)
            for (auto& entry : choice.objects) resolver.resolve(entry, true, "mapping.rx");
        for (auto& choice : file.tx)
            for (auto& entry : choice.objects) resolver.resolve(entry, false, "mapping.tx");
        check_rules(resolver, file.rx, file.device.rx_pdos, file.device.rx_rules, "mapping.rx");
        check_rules(resolver, file.tx, file.device.tx_pdos, file.device.tx_rules, "mapping.tx");
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
