#include "config/drive_file/drive_motion_tables.hpp"

#include "axes/port/quirk.hpp"
#include "config/drive_file/setting_tables.hpp"
#include "config/reading/codecs.hpp"

namespace taktwerk::config {

using axes::DriveMode;
using axes::DriveProfile;
using axes::Quirk;

namespace {

Codec<axes::DriveStop> drive_stop() {
    return choice<axes::DriveStop>({{"coast", axes::DriveStop::coast}, {"ramp", axes::DriveStop::ramp}});
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

}  // namespace

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

/// A key that stands in `motion` and in a room of the profile.
template <class Room, class M>
Field<DriveProfile> in_room(std::string key, Room DriveProfile::*room, M Room::*member, Codec<M> codec, std::string doc) {
    return field_at<DriveProfile>(
        std::move(key), [room, member](DriveProfile& p) -> M& { return p.*room.*member; }, std::move(codec), std::move(doc));
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
            in_room("encoder_turn_bits", &P::encoder, &axes::DriveEncoder::turn_bits, integer<std::uint8_t>(0, 32),
                    "width of an absolute encoder's turn counter; 0: not stated"),
            with_default(in_room("clear_turns", &P::encoder, &axes::DriveEncoder::clear_turns, parameter_address(),
                                 "object that makes the encoder forget its turns"),
                         "none"),
            in_room("clear_turns_value", &P::encoder, &axes::DriveEncoder::clear_turns_value, integer<std::int64_t>(0, 65535),
                    "written to that object"),
            in_room("clear_turns_control", &P::encoder, &axes::DriveEncoder::clear_turns_control, integer<std::uint16_t>(0, 0xFFFF),
                    "bits of 6040h that make the encoder forget its turns"),
            with_default(in_room("encoder_reset", &P::encoder, &axes::DriveEncoder::reset, parameter_address(),
                                 "object: 1 ends the encoder's fault and its turns, seen at the next power-on"),
                         "none"),
            in_room("battery_low", &P::encoder, &axes::DriveEncoder::battery_low, number(),
                    "V of the encoder's battery below which the drive warns; 0: not stated"),
            in_room("battery_empty", &P::encoder, &axes::DriveEncoder::battery_empty, number(),
                    "V below which the turns are lost at power-off; 0: not stated"),
            field("probes", &P::probes, integer<std::uint8_t>(0, 2), "touch probes"),
            in_room("motor_has_encoder", &P::encoder, &axes::DriveEncoder::present, boolean(), "false: the actual position is the command"),
            with_default(
                field("minimum_cycle_csp", &P::minimum_cycle_csp, duration(), "shortest cycle in cyclic synchronous position mode"),
                "not stated"),
            with_default(
                field("minimum_cycle_csv", &P::minimum_cycle_csv, duration(), "shortest cycle in cyclic synchronous velocity mode"),
                "not stated"),
            with_default(field("minimum_cycle_cst", &P::minimum_cycle_cst, duration(), "shortest cycle in cyclic synchronous torque mode"),
                         "not stated"),
            field("enable_delay", &P::enable_delay, duration(), "motion waits this long after enabling (brake)"),
            in_room("mode_change_delay", &P::mode_rules, &axes::DriveModeRules::change_delay, duration(),
                    "set-points wait this long after a mode change"),
            field("enable_timeout", &P::enable_timeout, duration(), "enabling that takes longer has failed"),
            in_room("mode_change_at_standstill", &P::mode_rules, &axes::DriveModeRules::change_at_standstill, boolean(),
                    "modes change only while it stands"),
            in_room("mode_change_interval", &P::mode_rules, &axes::DriveModeRules::change_interval, duration(),
                    "least time between two changes of 6060h"),
            in_room("mode_indeterminate", &P::mode_rules, &axes::DriveModeRules::indeterminate, duration(),
                    "6061h means nothing this long after a change of 6060h"),
            in_room("mode_violation", &P::mode_rules, &axes::DriveModeRules::violation,
                    choice<axes::ModeViolation>({{"obeyed", axes::ModeViolation::obeyed},
                                                 {"ignored", axes::ModeViolation::ignored},
                                                 {"alarm", axes::ModeViolation::alarm}}),
                    "what a change of mode leads to that comes too soon or in motion"),
            field("profile_buffer", &P::profile_buffer, integer<std::uint8_t>(1, 64), "set-points that PP takes behind the running one"),
            field("enable_status_bits", &P::enable_status_bits, integer<std::uint16_t>(0, u16),
                  "of 6041h, all set before Enable Operation"),
            in_room("brake_release", &P::brake, &axes::DriveBrake::release, duration(),
                    "after enabling the brake still holds: the drive loses earlier commands"),
            in_room("brake_hold", &P::brake, &axes::DriveBrake::hold, duration(),
                    "after disabling at standstill the motor holds until the brake does"),
            in_room("brake_moving_wait", &P::brake, &axes::DriveBrake::moving_wait, duration(),
                    "power gone in motion: the brake closes after this at the latest"),
            in_room("brake_moving_speed", &P::brake, &axes::DriveBrake::moving_speed, number(), "rpm below which it closes at once"),
            in_room(
                "brake_object", &P::brake, &axes::DriveBrake::object,
                choice<axes::BrakeObject>({{"none", axes::BrakeObject::none},
                                           {"output_bit", axes::BrakeObject::output_bit},
                                           {"mask_opens", axes::BrakeObject::mask_opens}}),
                "how the controller may work the brake. none: not at all · output_bit: 60FEh:01 bit 0 closes it (CiA 402) · mask_opens: "
                "60FEh:02 bit 0 opens it"),
            field("self_test", &P::self_test, duration(), "Not Ready To Switch On lasts this long after power-on"),
            field("deaf_after_enable", &P::deaf_after_enable, duration(), "set-points are not obeyed this long after enabling"),
            field("missed_frames_allowed", &P::missed_frames_allowed, integer<std::uint8_t>(0, 255),
                  "in a row in OP, one more is its communication alarm; 0: not counted"),
            field("overspeed_limit", &P::overspeed_limit, number(), "of the motor's maximum speed, beyond it an alarm; 0: none"),
            field("torque_overload", &P::torque_overload, number(), "rated torques, for longer than `torque_overload_time` an alarm"),
            field("torque_overload_time", &P::torque_overload_time, duration(), "how long more torque than `torque_overload` is allowed"),
            in_room("off_stop", &P::stops, &axes::DriveStops::off, drive_stop(), "power taken away while it moves"),
            in_room("fault_stop", &P::stops, &axes::DriveStops::fault, drive_stop(), "its reaction to a fault"),
            in_room("quick_stop_leaves", &P::stops, &axes::DriveStops::quick_stop_leaves, boolean(), "Quick Stop Active ends by itself"),
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

}  // namespace taktwerk::config
