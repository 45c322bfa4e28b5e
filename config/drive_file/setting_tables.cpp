#include "config/drive_file/setting_tables.hpp"

#include <limits>

#include "config/reading/codecs.hpp"

namespace taktwerk::config {

namespace {

Codec<std::int64_t> raw_value() {
    return integer<std::int64_t>(std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max());
}

Table<axes::UnitVariant> unit_variant_table() {
    using U = axes::UnitVariant;
    using V = axes::VelocityUnit;
    using A = axes::AccelerationUnit;
    return {
        "units.variants",
        "What one value of the unit object makes of the drive.",
        {
            required(field("value", &U::value, raw_value(), "of the unit object")),
            field("velocity", &U::velocity, choice<V>({{"profile", V::profile}, {"rpm", V::rpm}}),
                  "unit of 606Ch, 60FFh, 607Fh; profile: motion.velocity_counts_per_unit"),
            field("acceleration", &U::acceleration, choice<A>({{"counts", A::counts}, {"time", A::time}}),
                  "unit of 6083h, 6084h, 609Ah; time: ms to rated speed"),
            field("zero_limits_count", &U::zero_limits_count, boolean(), "torque limits of 0 hold the motor, whatever the limit masks say"),
            field("index_before_inputs", &U::index_before_inputs, boolean(),
                  "60FDh shows the index pulse in bit 16, the inputs from 17 on"),
            field("index_probe", &U::index_probe, boolean(), "touch probes can latch on the index pulse"),
            field("status_hidden", &U::status_hidden, integer<std::uint16_t>(0, 0xFFFF), "bits of 6041h that stay 0"),
            field("cyclic_bit_12", &U::cyclic_bit_12, boolean(), "6041h bit 12 in the cyclic modes: the drive follows (CiA 402-2)"),
        },
        {},
        {}};
}

Table<axes::AnalogueOutput> analogue_output_table() {
    using A = axes::AnalogueOutput;
    const auto object = parameter_address();
    return {"behaviour.analogue_outputs",
            "An analogue output that the bus sets: value / gain volts while the selection is 0.",
            {
                required(field("value", &A::value, object, "what the bus writes")),
                required(field("selection", &A::selection, object, "0: the bus sets the output")),
                required(field("gain", &A::gain, object, "divides the value")),
                field("monitor", &A::monitor, object, "shows the voltage in mV"),
            },
            {},
            {}};
}

Table<axes::VirtualInputs> virtual_inputs_table() {
    using V = axes::VirtualInputs;
    const auto object = parameter_address();
    return {"behaviour.virtual_inputs",
            "Inputs of the drive that exist in its parameters only.",
            {
                required(field("enable", &V::enable, object, "1: they count")),
                required(field("levels", &V::levels, object, "bit n is input n + 1")),
                required(field("functions", &V::functions, list(object), "of each input, in order")),
                field("servo_enable", &V::servo_enable, raw_value(), "the function that enables the motor"),
            },
            {},
            {}};
}

Table<axes::MotorObjects> motor_table() {
    using M = axes::MotorObjects;
    return {
        "behaviour.motor",
        "Which motor hangs on the drive.",
        {
            required(field("type", &M::type, parameter_address(), "object that chooses the kind")),
            required(field("open_loop", &M::open_loop, list(raw_value()), "its values without an encoder: the position is the command")),
            field("standby_current", &M::standby_current, parameter_address(), "% of the current at standstill, open loop"),
        },
        {},
        {}};
}

Table<axes::InputObjects> input_objects_table() {
    using I = axes::InputObjects;
    using U = axes::InputUse;
    const auto use = choice<U>({{"negative_limit", U::negative_limit}, {"positive_limit", U::positive_limit}, {"home", U::home}});
    return {"behaviour.inputs",
            "The switches on the drive's own terminals.",
            {
                required(field("terminals", &I::terminals, list(use), "what input 1, 2, ... are wired to")),
                field("polarity", &I::polarity, parameter_address(), "bit 0 is input 1: 0 normally open, 1 normally closed"),
                field("filter", &I::filter, duration(), "an active signal that lasts no longer is not seen"),
            },
            {},
            {}};
}

Table<axes::StateObjects::OfAlarm> alarm_state_table() {
    using A = axes::StateObjects::OfAlarm;
    return {"behaviour.state.alarms",
            "What the state object shows while an alarm stands.",
            {
                required(field("code", &A::code, integer<std::uint16_t>(1, 0xFFFF), "603Fh")),
                required(field("value", &A::value, raw_value(), "of the state object")),
            },
            {},
            {}};
}

Table<axes::StateObjects> state_table() {
    using S = axes::StateObjects;
    const auto object = parameter_address();
    return {"behaviour.state",
            "Objects of its own on which the drive shows state and errors.",
            {
                required(field("object", &S::state, object, "shows the state")),
                field("enabled", &S::enabled, raw_value(), "its value with power in the motor"),
                field("free", &S::free, raw_value(), "its value without"),
                field("alarms", &S::alarms, list(section(alarm_state_table())), "its values while an alarm stands"),
                field("error_code", &S::error_code, object, "as 603Fh"),
                field("error_sub_code", &S::error_sub_code, object, "of a communication error: 1 general, 2 SYNC, 3 watchdog"),
                field("history_next", &S::history_next, object, "place, from 1, of the next record"),
                field("history", &S::history, object, "first record of the ring; the others stand behind it"),
                field("history_length", &S::history_length, integer<std::uint8_t>(0, 32), "records in the ring"),
            },
            {},
            {}};
}

}  // namespace

Codec<axes::ParameterAddress> parameter_address() {
    Codec<axes::ParameterAddress> c;
    const auto address = object_address();
    c.shape = address.shape;
    c.read = [read = address.read](Reader& reader, const Node& node, axes::ParameterAddress& out) {
        ObjectAddress value;
        if (!read(reader, node, value)) return false;
        out = {value.index, value.sub};
        return true;
    };
    return c;
}

Table<axes::RequiredSetting> required_setting_table() {
    using R = axes::RequiredSetting;
    using A = axes::SettingApplies;
    Table<R> table{"required_settings",
                   "An object without whose value the drive must not be enabled; read each time the drive comes into OP.",
                   {
                       required(field("object", &R::object, parameter_address(), "that is read")),
                       with_default(field("values", &R::values, list(raw_value()), "any of them will do"), "any"),
                       with_default(field("cycles", &R::cycles, list(duration()),
                                          "instead of values: the object holds the place (from 0) of the bus cycle in this list"),
                                    "none"),
                       field("when", &R::when,
                             choice<A>({{"always", A::always}, {"with_clocks", A::with_clocks}, {"without_clocks", A::without_clocks}}),
                             "whether it counts only with, or without, SYNC0 on the slave"),
                       required(field("text", &R::text, text(), "what goes wrong with another value, in one sentence")),
                       required(field("remedy", &R::remedy, text(), "what to write, and when it takes effect")),
                       required(field("section", &R::section, text(), "of the manual")),
                   },
                   {},
                   {}};
    table.after = [](Reader& reader, const Node& node, R& row) {
        if (row.values.empty() == row.cycles.empty())
            reader.problem(node.at, "config.required_setting", "a required setting has either `values` or `cycles`", "write one of them");
    };
    return table;
}

Table<axes::DriveUnits> units_table() {
    using U = axes::DriveUnits;
    return {
        "units",
        "An object of the drive that chooses its units; the runtime reads it and scales accordingly.",
        {
            required(field("object", &U::object, parameter_address(), "that chooses")),
            field("counts_per_revolution", &U::counts_per_revolution, parameter_address(), "object with the counts of a motor revolution"),
            required(field("variants", &U::variants, list(section(unit_variant_table())), "by its value")),
        },
        {},
        {}};
}

Table<axes::ScaleObjects> scale_table() {
    using S = axes::ScaleObjects;
    const auto object = parameter_address();
    return {
        "scale",
        "Objects that say how many position counts are one turn of the motor: compared with the axis before it is enabled.",
        {
            field("counts", &S::counts, object, "counts of a turn; 0 in it: encoder and gear, if there are"),
            field("counts_high", &S::counts_high, object, "its high part"),
            field("counts_high_unit", &S::counts_high_unit, raw_value(), "what one of `counts_high` is in counts"),
            field("encoder", &S::encoder, object, "counts of the encoder a turn; the simulated motor has the encoder that fits its axis"),
            field("numerator", &S::numerator, object, "encoder counts = counts * numerator / denominator"),
            field("denominator", &S::denominator, object, "see numerator"),
            with_default(
                field("only_one", &S::only_one, list(object), "ratios whose part is not stated: with another value than 1 nobody knows"),
                "none"),
            with_default(field("doubt", &S::doubt, text(), "why what they read may not be what is in force, or why nobody knows"), ""),
            required(field("remedy", &S::remedy, text(), "how the drive is given another scale")),
            required(field("section", &S::section, text(), "of the manual")),
        },
        {},
        {}};
}

Table<axes::BehaviourObjects> behaviour_table() {
    using B = axes::BehaviourObjects;
    Table<B> table{"behaviour", "Objects that the simulated drive obeys.", {}, {}, {}};
    auto& f = table.fields;
    const auto object = parameter_address();
    f.push_back(field("bus_control", &B::bus_control, object, "unless it holds `bus_control_value`, control word and mode mean nothing"));
    f.push_back(field("bus_control_value", &B::bus_control_value, raw_value(), "see bus_control"));
    f.push_back(field("absolute_targets", &B::absolute_targets, object, "0: a target in CSP is an increment, 1: a position"));
    f.push_back(field("limit_masks", &B::limit_masks, object, "bit 0: torque limits of 0 are ignored, bit 1: a speed limit of 0 is"));
    f.push_back(field("lost_target_cycles", &B::lost_target_cycles, object, "cycles that CSP goes on without process data"));
    f.push_back(field("lost_data_time", &B::lost_data_time, object, "ms without process data until the alarm, while enabled"));
    f.push_back(field("sync_type", &B::sync_type, object, "2: SYNC0 is watched while enabled, 0: free run"));
    f.push_back(field("output_control", &B::output_control, object, "1: 60FEh drives the outputs"));
    f.push_back(field("analogue_outputs", &B::analogue_outputs, list(section(analogue_output_table())), "that the bus sets"));
    f.push_back(field("bus_state", &B::bus_state, object, "shows 10 + AL state"));
    f.push_back(field("parameter_tunnel", &B::parameter_tunnel, object,
                      "array that reaches any object: sub 1 index << 8 | sub-index, sub 2 value, sub 3 result"));
    f.push_back(field("following_limit", &B::following_limit, object, "counts of following error that are an alarm, 0: no check"));
    f.push_back(field_at<B>(
        "probe_input_1", [](B & b) -> auto& { return b.probe_input[0]; }, object, "must be 0 for the input of probe 1 to latch"));
    f.push_back(field_at<B>(
        "probe_input_2", [](B & b) -> auto& { return b.probe_input[1]; }, object, "must be 0 for the input of probe 2 to latch"));
    f.push_back(field("sync_losses", &B::sync_losses, object, "SYNC0 in a row that may be missing or out of place"));
    f.push_back(field("sync_deviation", &B::sync_deviation, object, "ns by which two SYNC0 may be closer or further apart than the cycle"));
    f.push_back(field("phase_detection", &B::phase_detection, object,
                      "a missing mains phase is 0: a fault, 1: a warning until the motor is enabled, 2: nothing"));
    f.push_back(field("virtual_inputs", &B::virtual_inputs, section(virtual_inputs_table()), "that have functions like terminals"));
    f.push_back(field("least_voltage", &B::least_voltage, object, "V of the supply, below it an alarm"));
    f.push_back(field("greatest_voltage", &B::greatest_voltage, object, "V of the supply, above it an alarm"));
    f.push_back(field("motor", &B::motor, section(motor_table()), "which motor hangs on it"));
    f.push_back(field("inputs", &B::inputs, section(input_objects_table()), "switches on its own terminals"));
    f.push_back(field("state", &B::state, section(state_table()), "objects that show state and errors"));
    return table;
}

}  // namespace taktwerk::config
