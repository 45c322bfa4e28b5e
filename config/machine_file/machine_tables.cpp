#include "config/machine_file/machine_tables.hpp"

#include <cmath>

#include <fmt/format.h>

#include "config/drive_file/drive_tables.hpp"
#include "config/machine_file/axis_tables.hpp"
#include "config/machine_file/bus_tables.hpp"
#include "config/machine_file/modbus_server_tables.hpp"
#include "config/machine_file/modbus_tables.hpp"
#include "config/machine_file/view_tables.hpp"
#include "config/reading/codecs.hpp"
#include "config/reading/quantity.hpp"
#include "config/reading/unit_text.hpp"

namespace taktwerk::config {

namespace {

using namespace std::chrono_literals;
using runtime::SimulationEvent;

// --- inputs and outputs ---------------------------------------------------------------------------------------------------

/// `1`, or `ai1`.
Codec<std::string> channel_name() {
    auto c = text();
    c.read = [](Reader& reader, const Node& node, std::string& out) {
        if (node.kind == Node::Kind::scalar && !node.text.empty() && !(parse_integer(node.text) && *parse_integer(node.text) < 1)) {
            out = node.text;
            return true;
        }
        report_wrong_type(reader, node, "the name or the number of a channel, from 1", "1");
        return false;
    };
    return c;
}

Table<PointScale> scale_table() {
    using S = PointScale;
    return {"scale",
            "What the terminal measures, and what that means: `from: [4 mA, 20 mA], to: [0 bar, 16 bar]`.",
            {
                required(field("from", &S::from, measure_pair(), "two values of the channel in its unit, or two raw numbers without one")),
                required(field("to", &S::to, measure_pair(), "what these are")),
            },
            {},
            {}};
}

std::vector<Field<IoEntry>> io_fields() {
    using E = IoEntry;
    return {
        required(field_at<E>(
            "slave", [](E & e) -> auto& { return e.point.slave; }, name(), "slave that has it, or device of `modbus_tcp`")),
        field("channel", &E::channel, channel_name(),
              "of a terminal: its name in the device file, or its number among those of the direction, from 1; of a Modbus device: its "
              "name among `registers`"),
        field("object", &E::object, maybe(object_address()), "or an object in the process data, such as 60FDh"),
        field_at<E>(
            "inverted", [](E & e) -> auto& { return e.point.inverted; }, boolean(), "TRUE while the terminal says 0"),
        field("scale", &E::scale, maybe(section(scale_table())), "what its number means, where that is not what the device file says"),
    };
}

void check_io(Reader& reader, const Node& node, IoEntry& e) {
    if (node.find("channel") == nullptr && node.find("object") == nullptr)
        reader.problem(node.at, "config.missing_key", fmt::format("`{}` has neither `channel` nor `object`", reader.path()),
                       "add `channel:` with its name or its number on the terminal, from 1");
    if (!e.channel.empty() && e.object)
        reader.problem(node.at, "config.conflict", fmt::format("`{}` has both `channel` and `object`", reader.path()), "keep one of them");
}

constexpr auto least = std::numeric_limits<std::int32_t>::min();
constexpr auto most = std::numeric_limits<std::int32_t>::max();

Table<IoEntry> input_table() {
    using E = IoEntry;
    Table<E> table{"io.inputs.<name>", "An input by the name that programs use.", io_fields(), {}, check_io};
    table.fields.push_back(with_default(field("limits", &E::limits, maybe(measure_pair()),
                                              "between which values it is right; outside an alarm warns, and ctx.good() is false"),
                                        "none"));
    table.fields.push_back(field_at<E>(
        "filter", [](E & e) -> auto& { return e.point.filter; }, duration(), "time constant of a first-order filter on its value"));
    table.fields.push_back(
        field("simulated", &E::simulated, maybe(measure()),
              "what the field says at first in a simulation: 0 or 1, before `inverted`; `7.5 bar`; else the raw number"));
    return table;
}

Table<IoEntry> output_table() {
    using E = IoEntry;
    Table<E> table{"io.outputs.<name>", "An output by the name that programs use.", io_fields(), {}, check_io};
    table.fields.push_back(with_default(
        field("safe", &E::safe, maybe(measure()), "from the bus' first frames on and while no program drives it; `0 V`, or the raw number"),
        "0"));
    return table;
}

Field<MachineFile> io_field() {
    using F = MachineFile;
    const auto point_name = [](IoEntry& e) -> std::string& { return e.point.name; };
    return group<F>("io", "Inputs and outputs by name.",
                    {
                        field("inputs", &F::inputs, by_name(section(input_table()), point_name), "inputs"),
                        field("outputs", &F::outputs, by_name(section(output_table()), point_name), "outputs"),
                    });
}

// --- serial lines -----------------------------------------------------------------------------------------------------------

Codec<axes::xp200::ConductingReads> conducting_reads() {
    using C = axes::xp200::ConductingReads;
    return choice<C>({{"zero", C::zero}, {"one", C::one}});
}

Codec<NamedParameter> parameter_setting() {
    Codec<NamedParameter> c;
    const auto whole = integer<std::int64_t>(least, most);
    c.shape = whole.shape;
    c.read = [whole](Reader& reader, const Node& node, NamedParameter& out) { return whole.read(reader, node, out.value); };
    return c;
}

Table<SerialDriveEntry> serial_drive_entry_table() {
    using E = SerialDriveEntry;
    using runtime::UnsupervisedLine;
    return {
        "serial.<name>.drives.<name>",
        "A drive on the line. What happens when the line dies must be said: `watchdog_output`, or `unsupervised_line: accepted`.",
        {
            required(field("profile", &E::profile, name(), "its type, such as xp200")),
            required(field_at<E>(
                "station", [](E & e) -> auto& { return e.drive.drive.station; }, integer<std::uint8_t>(1, 247), "its address; Pr181")),
            field("parameters", &E::parameters, by_name(parameter_setting(), [](NamedParameter& p) -> std::string& { return p.name; }),
                  "what its parameters shall be: `Pr136: 1`. Written when the line comes up, where a write counts at once; else compared"),
            field_at<E>(
                "watchdog_output", [](E & e) -> auto& { return e.drive.watchdog_output; }, name(),
                "output that is on while the line is heard, wired to an input with function -15 (EMG, open = stop)"),
            field_at<E>(
                "unsupervised_line", [](E & e) -> auto& { return e.drive.unsupervised_line; },
                choice<UnsupervisedLine>({{"refused", UnsupervisedLine::refused}, {"accepted", UnsupervisedLine::accepted}}),
                "accepted: something else stops the axis when the line dies, and whoever writes this answers for it"),
            field_at<E>(
                "conducting_inputs", [](E & e) -> auto& { return e.drive.drive.inputs; }, conducting_reads(),
                "what a conducting input reads in status 0012h"),
            field_at<E>(
                "conducting_outputs", [](E & e) -> auto& { return e.drive.drive.outputs; }, conducting_reads(),
                "what a conducting output reads in status 0013h"),
            field_at<E>(
                "silence", [](E & e) -> auto& { return e.drive.drive.silence; }, duration(100ms, 10s),
                "without an answer for so long the line counts as silent"),
        },
        {},
        {}};
}

Table<SerialLineEntry> serial_line_table() {
    using E = SerialLineEntry;
    using modbus::Parity;
    return {"serial.<name>",
            "A serial line (RS-485) with the drives on it.",
            {
                with_default(field_at<E>(
                                 "device", [](E & e) -> auto& { return e.line.device; }, text(), "the port, such as /dev/ttyUSB0"),
                             "simulated"),
                field_at<E>(
                    "baud", [](E & e) -> auto& { return e.line.settings.baud; }, integer<std::uint32_t>(4800, 38400), "as Pr182 says"),
                field_via<E>(
                    "format", choice<int>({{"8N1", 0}, {"8E1", 1}, {"8O1", 2}, {"8N2", 3}, {"8E2", 4}, {"8O2", 5}}),
                    [](E& e, const int& code) {
                        const int parity = code % 3;
                        e.line.settings.parity = parity == 0 ? Parity::none : parity == 1 ? Parity::even : Parity::odd;
                        e.line.settings.stop_bits = code < 3 ? 1 : 2;
                    },
                    "as Pr183 says", "8E1"),
                field("drives", &E::drives,
                      by_name(section(serial_drive_entry_table()), [](SerialDriveEntry& d) -> std::string& { return d.drive.drive.name; }),
                      "by name"),
            },
            {},
            {}};
}

// --- programs -------------------------------------------------------------------------------------------------------------

Codec<TaskPeriod> task_period() {
    Codec<TaskPeriod> c;
    c.shape.kind = Shape::Kind::quantity;
    c.shape.dimension = Dimension::cycles;
    c.read = [cycles = quantity(Dimension::cycles, 1).read](Reader& reader, const Node& node, TaskPeriod& out) {
        if (node.kind == Node::Kind::scalar) {
            const auto time = parse_quantity(node.text, Dimension::time, {});
            if (time.problem == QuantityProblem::none) {
                const auto period = time.value > 0 && time.value < 1e6 ? from_seconds(time.value) : Duration{};
                if (period <= 0ns || reader.cycle <= 0ns || period % reader.cycle != 0ns || period / reader.cycle > 65535) {
                    reader.problem(node.at, "config.out_of_range", fmt::format("`{}` is not a multiple of the machine's cycle", node.text),
                                   "give whole cycles, such as `4 cycles`");
                    return false;
                }
                out = {0, period};
                return true;
            }
        }
        double value = 0;
        if (!cycles(reader, node, value)) return false;
        if (value != std::floor(value) || value > 65535) {
            reader.problem(node.at, "config.out_of_range", "a task runs every 1 to 65535 whole cycles", "write for instance `4 cycles`");
            return false;
        }
        out = {value, {}};
        return true;
    };
    return c;
}

Table<TaskEntry> task_table() {
    using T = TaskEntry;
    using runtime::OverrunReaction;
    return {
        "programs.<name>.tasks.<task>",
        "When a task of the program runs.",
        {
            with_default(
                field("every", &T::every, task_period(), "`1 cycles` runs inline in the machine's cycle; `8 ms` or `8 cycles` beside it"),
                "1 cycles"),
            field_at<T>(
                "overrun", [](T & t) -> auto& { return t.task.overrun; },
                choice<OverrunReaction>({{"count", OverrunReaction::count},
                                         {"stop_program", OverrunReaction::stop_program},
                                         {"stop_machine", OverrunReaction::stop_machine}}),
                "when it was not finished at more releases in a row than allowed: nothing but counting, its program stops with its axes "
                "and outputs, or all axes stop"),
            field_at<T>(
                "overruns_allowed", [](T & t) -> auto& { return t.task.overruns_allowed; }, integer<std::uint16_t>(0, 65535),
                "in a row, before that"),
            with_default(field_at<T>(
                             "watchdog", [](T & t) -> auto& { return t.task.watchdog; }, maybe(duration(0ms, 1h)),
                             "how long a run may take from its release on; its program is stopped then. 0 ms: no limit"),
                         "10 periods, at least 250 ms; with relaxed supervision ten times as long"),
            field_at<T>(
                "watchdog_sensitivity", [](T & t) -> auto& { return t.task.watchdog_sensitivity; }, integer<std::uint16_t>(1, 65535),
                "so many runs in a row must take longer than `watchdog`, or one so many times as long"),
            with_default(field_at<T>(
                             "priority", [](T & t) -> auto& { return t.task.priority; }, maybe(integer<int>(0, 99)),
                             "SCHED_FIFO priority of its thread, below the cycle's; 0 = leave"),
                         "by its period, 49 and below"),
        },
        {},
        {}};
}

/// A number, or true and false as 1 and 0. Units and ranges are the program's own, checked when it is loaded.
Codec<runtime::ParameterValue> parameter() {
    Codec<runtime::ParameterValue> c;
    const auto plain = number();
    c.shape.kind = Shape::Kind::either;
    c.shape.alternatives = {std::make_shared<const Shape>(plain.shape), std::make_shared<const Shape>(boolean().shape),
                            std::make_shared<const Shape>(text().shape)};  // with a unit
    c.read = [plain](Reader& reader, const Node& node, runtime::ParameterValue& out) {
        if (node.kind == Node::Kind::scalar && !node.quoted && (node.text == "true" || node.text == "false")) {
            out.value = node.text == "true" ? 1 : 0;
            return true;
        }
        if (node.kind == Node::Kind::scalar && !parse_number(node.text)) {
            for (auto& one : in_every_unit(node.text)) out.in_units.push_back({std::move(one.unit), one.value});
            if (!out.in_units.empty()) {
                out.text = node.text;
                return true;
            }
        }
        return plain.read(reader, node, out.value);
    };
    return c;
}

Table<ProgramFile> program_table() {
    using P = ProgramFile;
    return {
        "programs.<name>",
        "A machine program: a shared object built against the SDK.",
        {
            required(field_at<P>(
                "library", [](P & p) -> auto& { return p.program.library; }, text(),
                "the shared object, looked up beside the machine file and in the program path")),
            field_at<P>(
                "autostart", [](P & p) -> auto& { return p.program.autostart; }, boolean(),
                "starts when the machine is up, in automatic mode"),
            field_at<P>(
                "parameters", [](P & p) -> auto& { return p.program.parameters; },
                by_name(parameter(), [](runtime::ParameterValue& v) -> std::string& { return v.name; }),
                "initial values: a bare number in the unit that the program declares, or a number with a unit that converts to it"),
            with_default(field("tasks", &P::tasks, by_name(section(task_table()), [](TaskEntry& t) -> std::string& { return t.task.name; }),
                               "tasks that the program declares"),
                         "`main`, each cycle"),
        },
        {},
        {}};
}

// --- simulation -------------------------------------------------------------------------------------------------------------

struct EventWord {
    const char* key;
    SimulationEvent::Kind kind;
    std::int64_t value;
    const char* doc;
};
using EventKind = SimulationEvent::Kind;
constexpr EventWord event_words[] = {
    {"input", EventKind::input, 0, "an input takes `value`: 0 or 1, an analog one its raw number"},
    {"input_fault", EventKind::input_fault, 1, "the terminal reports an error of this input, such as a broken wire"},
    {"input_whole", EventKind::input_fault, 0, "and takes it back"},
    {"drive_fault", EventKind::drive_fault, 0, "the drive of this axis raises the alarm `code`"},
    {"main_power_off", EventKind::main_power, 0, "the drive of this axis loses its main power"},
    {"main_power_on", EventKind::main_power, 1, "and gets it back"},
    {"slave_power_off", EventKind::slave_power, 0, "this slave falls silent"},
    {"slave_power_on", EventKind::slave_power, 1, "and comes back"},
    {"connect", EventKind::group, 1, "this group of `hot_connect` is coupled, with its supply"},
    {"disconnect", EventKind::group, 0, "and taken away"},
    {"line_cut", EventKind::serial_line, 0, "this serial line carries nothing any more"},
    {"line_plugged", EventKind::serial_line, 1, "and carries again"},
    {"jam", EventKind::jam, 0, "the mechanics of this axis do not move any more"},
    {"free", EventKind::jam, 1, "and move again"},
};

Table<SimulationEvent> event_table() {
    using E = SimulationEvent;
    Table<E> table{"simulation.events",
                   "Something that happens to the simulated machine: `at` and one event.",
                   {required(with_default(field("at", &E::at, duration(), "since the start of the run"), ""))},
                   {},
                   {}};
    for (const auto& word : event_words)
        table.fields.push_back(field_via<E>(
            word.key, name(), [word](E& e, const std::string& target) { e.kind = word.kind, e.target = target, e.value = word.value; },
            word.doc));
    table.fields.push_back(field_via<E>(
        "value", integer<std::int64_t>(least, most), [](E& e, const std::int64_t& v) { e.value = v; }, "of `input`"));
    table.fields.push_back(field_via<E>(
        "code", integer<std::int64_t>(1, 0xFFFF), [](E& e, const std::int64_t& v) { e.value = v; }, "of `drive_fault`: 603Fh"));
    table.after = [](Reader& reader, const Node& node, E&) {
        int events = 0;
        for (const auto& word : event_words) events += node.find(word.key) ? 1 : 0;
        if (events != 1)
            reader.problem(node.at, "config.event", events == 0 ? "the event says when, but not what" : "one event holds several",
                           "give exactly one of input, input_fault, input_whole, drive_fault, main_power_off, main_power_on, "
                           "slave_power_off, slave_power_on, connect, disconnect, "
                           "line_cut, line_plugged, jam, free");
        const auto pair = [&](const char* key, const char* value) {
            if ((node.find(key) != nullptr) != (node.find(value) != nullptr))
                reader.problem(node.at, "config.event", fmt::format("`{}` and `{}` belong together", key, value),
                               fmt::format("write both: `{}: ..., {}: ...`", key, value));
        };
        pair("input", "value");
        pair("drive_fault", "code");
    };
    return table;
}

Table<runtime::SlaveSimulation> slave_simulation_table() {
    using S = runtime::SlaveSimulation;
    return {
        "simulation.slaves",
        "Where a simulated slave hangs. The list `bus.slaves` stays in the order in which a frame reaches them: of the branches behind one "
        "slave that at port 3 first, then 1, then 2.",
        {
            with_default(field("behind", &S::behind, name(), "the slave that its cable comes from"), "the one before it in `bus.slaves`"),
            field("port", &S::port, integer<std::uint8_t>(1, 3), "that slave's socket"),
            field("cable", &S::cable, number(0, 10000), "length of the cable, in metres"),
            with_default(field("drift", &S::drift_ppm, maybe(quantity(Dimension::ratio_ppm)), "how wrong its clock runs"),
                         "`clock_drift` of its axis"),
        },
        {},
        {}};
}

Table<runtime::GroupSimulation> group_simulation_table() {
    using G = runtime::GroupSimulation;
    Table<G> table{
        "simulation.groups",
        "How a simulated group of `hot_connect` is coupled: by hand (`taktwerk simulate FILE \"connect GROUP\"`, events), or by an output.",
        {
            field("connected", &G::connected, boolean(), "at the start"),
            with_default(field("released_by", &G::released_by, name(),
                               "output of the machine that opens the coupling: it lets the group go when it rises; when it falls, the "
                               "coupling takes what it stands at"),
                         "by hand alone"),
            with_default(field("axis", &G::axis, name(), "that carries the coupling: it takes only what it stands at"), "anywhere"),
            field("at", &G::at, number(-1e9, 1e9), "in the axis' unit: where the group lies"),
            field("within", &G::within, number(0, 1e9), "in the axis' unit: how near counts"),
        },
        {},
        {}};
    table.after = [](Reader& reader, const Node& node, G&) {
        if (node.find("axis") != nullptr && node.find("released_by") == nullptr)
            reader.problem(node.at, "config.missing_key", "`axis` says where the group is taken, and nothing takes it",
                           "add `released_by:` with an output, or remove `axis`");
        if ((node.find("axis") != nullptr) != (node.find("at") != nullptr))
            reader.problem(node.at, "config.missing_key", "`axis` and `at` belong together", "write both: `axis: x, at: 100`");
    };
    return table;
}

Table<runtime::SimulationConfig> simulation_table() {
    using S = runtime::SimulationConfig;
    using runtime::Supervision;
    return {
        "simulation",
        "Used when the bus is simulated.",
        {
            field("supervision", &S::supervision, choice<Supervision>({{"strict", Supervision::strict}, {"relaxed", Supervision::relaxed}}),
                  "relaxed: for hosts without real time; misses are counted, limits are 100 times wider"),
            field("slaves", &S::slaves,
                  by_name(section(slave_simulation_table()), [](runtime::SlaveSimulation& s) -> std::string& { return s.slave; }),
                  "slaves that do not simply follow the one before them"),
            field("groups", &S::groups,
                  by_name(section(group_simulation_table()), [](runtime::GroupSimulation& g) -> std::string& { return g.group; }),
                  "how groups of `hot_connect` are coupled"),
            with_default(field("events", &S::events, list(section(event_table())), "what happens, and when"), ""),
        },
        {},
        {}};
}

// --- the rest ---------------------------------------------------------------------------------------------------------------

Table<runtime::EmergencyStop> emergency_stop_table() {
    using E = runtime::EmergencyStop;
    return {
        "emergency_stop",
        "Reaction of the software. What protects people belongs in hardware.",
        {
            required(field("input", &E::input, name(), "input that is TRUE while all is well")),
            field("power_off_after", &E::power_off_after, duration(1ms, 60s), "power goes off when the axes stand, at the latest then"),
            with_default(field("restart", &E::restart, name(),
                               "input of a button, pressed after the release: a first press resets the axes, the next one lets programs "
                               "power them again"),
                         "`taktwerk start` alone"),
        },
        {},
        {}};
}

Table<runtime::RecordingConfig> recording_table() {
    using R = runtime::RecordingConfig;
    return {"recording",
            "Every signal of every cycle stays in memory for a while: for the scope, and for a recording around each alarm that stops an "
            "axis or "
            "the machine. `taktwerk check` says how many bytes that takes.",
            {
                field("depth", &R::depth, duration(100ms, 1h), "so long a signal can be looked back at"),
                with_default(field("directory", &R::directory, text(), "folder for the recordings; relative to this file"),
                             "`/var/lib/taktwerk/recordings`; simulated: beside the command socket"),
                field("files", &R::files, integer<std::uint16_t>(0, 10000), "so many recordings are kept, the newest; 0: none is made"),
                field("before", &R::before, duration(100ms, 1h), "what a recording shows before its alarm"),
                field("after", &R::after, duration(100ms, 10min), "and behind it"),
                field("replay", &R::replay, boolean(),
                      "the run from its start up to there is kept as well, for `taktwerk replay`; false, below a cycle of 1 ms and with "
                      "`realtime: {required: true}`: no run is, and the bus' scripts have a thread of their own"),
                field("replay_memory", &R::replay_memory, integer<std::uint32_t>(1, 65536),
                      "MB that the run may have in memory; what is more goes to the disk"),
                field("replay_disk", &R::replay_disk, integer<std::uint32_t>(1, 10'000'000),
                      "MB of all runs that are kept; the oldest go, and the one that runs ends there"),
            },
            {},
            {}};
}

Table<runtime::EvidenceConfig> evidence_table() {
    using E = runtime::EvidenceConfig;
    return {
        "evidence",
        "What was on the bus from some seconds before until a second after each alarm that stops something: a pcapng file each, with the "
        "alarm at its frame.",
        {
            required(field("directory", &E::directory, text(), "folder for the files; relative to this file")),
            field("files", &E::files, integer<std::uint16_t>(0, 10000), "so many are kept, the newest; 0: all"),
            field("megabytes", &E::megabytes, integer<std::uint16_t>(1, 1024),
                  "of memory for the last frames, taken twice: one frame of 200 bytes a millisecond fills 16 in half a minute"),
        },
        {},
        {}};
}

/// A directory alone, or with how often and on which input.
Codec<runtime::RetainConfig> retain() {
    using R = runtime::RetainConfig;
    const auto whole =
        section(Table<R>{"retain",
                         "What is kept over a time without power: variables and blocks that programs keep, parameters that operators set, "
                         "positions of axes with "
                         "absolute encoders.",
                         {
                             required(field("directory", &R::directory, text(), "its folder, this machine's alone; relative to this file")),
                             field("every", &R::every, duration(std::chrono::milliseconds{10}, std::chrono::hours{1}),
                                   "values that change are written at most this often: no more is lost with the power"),
                             with_default(field("power_fail", &R::power_fail, text(),
                                                "input that is TRUE when the supply fails: values are written at once"),
                                          "none"),
                         },
                         {},
                         {}});
    Codec<R> c;
    c.shape.kind = Shape::Kind::either;
    c.shape.alternatives = {std::make_shared<const Shape>(text().shape), std::make_shared<const Shape>(whole.shape)};
    c.read = [whole](Reader& reader, const Node& node, R& out) {
        return node.kind == Node::Kind::map ? whole.read(reader, node, out) : text().read(reader, node, out.directory);
    };
    return c;
}

Table<hmi::HistoryConfig> history_table() {
    using H = hmi::HistoryConfig;
    return {"history",
            "Every alarm with its words and times, kept over restarts; `taktwerk alarms --history` and the page show it.",
            {
                with_default(field("directory", &H::directory, text(), "folder for its file; relative to this file"),
                             "the state directory of the service, else /var/lib/taktwerk where it may be written, else beside the socket"),
                field("rows", &H::rows, integer<std::int64_t>(0, 1'000'000), "so many alarms are kept, the newest; 0: no history"),
            },
            {},
            {}};
}

Table<runtime::CycleWatch> watch_table() {
    using W = runtime::CycleWatch;
    return {"watch",
            "When the machine's own cycle comes too late.",
            {
                field("overruns_allowed", &W::overruns_allowed, integer<std::uint16_t>(0, 65535),
                      "missed cycles in a row until the machine stops"),
                with_default(field("lateness_warning", &W::lateness_warning, duration(), "a cycle later than this is counted as late"),
                             "a quarter of the cycle"),
            },
            {},
            {}};
}

Table<runtime::RealtimeConfig> realtime_table() {
    using R = runtime::RealtimeConfig;
    return {"realtime",
            "What is asked of the operating system. What it refuses is reported, and the machine runs on unless `required`.",
            {
                field("priority", &R::priority, integer<int>(0, 99), "SCHED_FIFO priority of the cycle; 0 = leave"),
                with_default(field("cpus", &R::cpus, list(integer<int>(0, 1023)), "processors for the cycle"), "any"),
                field("lock_memory", &R::lock_memory, boolean(), "keep all memory resident"),
                field("required", &R::required, boolean(), "refuse to start where something is not granted"),
            },
            {},
            {}};
}

Table<hmi::HmiConfig> hmi_table() {
    using H = hmi::HmiConfig;
    using hmi::LcmCommands;
    return {
        "hmi",
        "How the state goes out and commands come in.",
        {
            field("rate", &H::rate_hz, quantity(Dimension::frequency, 1), "of the state messages: 1 Hz to 1000 Hz"),
            with_default(field("socket", &H::socket, text(), "Unix socket of the command line"),
                         "by the machine's name in the run-time directory"),
            with_default(field("socket_group", &H::socket_group, name(), "group whose members may command over it"), "that of the process"),
            group<H>("lcm", "Publishing over LCM.",
                     {
                         field("enabled", &H::lcm, boolean(), "publish the state"),
                         field("url", &H::lcm_url, text(), "multicast group, port and reach"),
                         field("required", &H::lcm_required, boolean(), "refuse to run without it"),
                         field("commands", &H::lcm_commands,
                               choice<LcmCommands>({{"disabled", LcmCommands::disabled}, {"local", LcmCommands::local}}),
                               "local: every process of this computer may command the machine"),
                     }),
        },
        {},
        {}};
}

}  // namespace

Table<MachineFile> machine_table() {
    using F = MachineFile;
    using runtime::Mode;
    using runtime::SendMode;
    Table<F> table{"machine file",
                   "One machine: bus, axes, inputs and outputs, programs. Values with a dimension carry their unit: `1 ms`, `100 mm/s`.",
                   {},
                   {},
                   {}};
    auto& f = table.fields;
    f.push_back(version_field(&F::version));
    f.push_back(required(field_at<F>(
        "name", [](F & m) -> auto& { return m.machine.name; }, name(), "of the machine")));
    auto cycle = duration(100us, 100ms);
    const auto read_cycle = cycle.read;
    cycle.read = [read_cycle](Reader& reader, const Node& node, Duration& out) {
        const bool good = read_cycle(reader, node, out);
        reader.cycle = out;
        return good;
    };
    f.push_back(required(field_at<F>(
        "cycle", [](F & m) -> auto& { return m.machine.cycle; }, std::move(cycle), "of the machine and its bus")));
    f.push_back(field_at<F>(
        "send", [](F & m) -> auto& { return m.machine.send; },
        choice<SendMode>({{"after_plan", SendMode::after_plan}, {"at_tick", SendMode::at_tick}}),
        "after_plan: outputs leave as soon as they are computed · at_tick: at the next tick, at a constant time, one cycle later"));
    f.push_back(field_at<F>(
        "start_mode", [](F & m) -> auto& { return m.machine.start_mode; },
        choice<Mode>({{"manual", Mode::manual}, {"setup", Mode::setup}, {"automatic", Mode::automatic}}),
        "mode in which the machine comes up; programs run in automatic"));
    f.push_back(required(bus_field()));
    f.push_back(field("serial", &F::serial,
                      by_name(section(serial_line_table()), [](SerialLineEntry& l) -> std::string& { return l.line.name; }),
                      "serial lines, beside the bus or alone"));
    f.push_back(modbus_field());
    f.push_back(modbus_server_field());
    f.push_back(io_field());
    f.push_back(field_at<F>(
        "axes", [](F & m) -> auto& { return m.machine.axes; },
        by_name(section(axis_table()), [](runtime::AxisBinding& b) -> std::string& { return b.axis.name; }),
        "what programs move; none: only a bus"));
    f.push_back(field("groups", &F::groups, by_name(section(group_table()), [](GroupEntry& g) -> std::string& { return g.group.name; }),
                      "axes that move together on a path"));
    f.push_back(field("paths", &F::paths, by_name(section(path_table()), [](PathEntry& p) -> std::string& { return p.path.name; }),
                      "programs in G-code that groups go"));
    f.push_back(field("cams", &F::cams, by_name(section(cam_table()), [](CamEntry& c) -> std::string& { return c.cam.name; }),
                      "tables that slaves follow; programs may declare others"));
    f.push_back(field("programs", &F::programs,
                      by_name(section(program_table()), [](ProgramFile& p) -> std::string& { return p.program.name; }),
                      "what runs on the machine; none is fine"));
    f.push_back(field_at<F>(
        "emergency_stop", [](F & m) -> auto& { return m.machine.emergency_stop; }, section(emergency_stop_table()),
        "reaction of the software"));
    f.push_back(field_at<F>(
        "watch", [](F & m) -> auto& { return m.machine.watch; }, section(watch_table()), "when the cycle comes too late"));
    f.push_back(field_at<F>(
        "realtime", [](F & m) -> auto& { return m.machine.realtime; }, section(realtime_table()), "what is asked of the operating system"));
    f.push_back(with_default(field_at<F>(
                                 "retain", [](F & m) -> auto& { return m.machine.retain; }, retain(),
                                 "what is kept over a time without power: a directory, relative to this file, or a section with more"),
                             "none: programs begin with their first values, axes are homed after each start"));
    f.push_back(with_default(field_at<F>(
                                 "evidence", [](F & m) -> auto& { return m.machine.evidence; }, section(evidence_table()),
                                 "what was on the bus around each alarm that stops something, as a file for Wireshark"),
                             "none"));
    f.push_back(field_at<F>(
        "recording", [](F & m) -> auto& { return m.machine.recording; }, section(recording_table()),
        "the memory of the scope, and what is kept around each alarm that stops something"));
    f.push_back(field_at<F>(
        "history", [](F & m) -> auto& { return m.hmi.history; }, section(history_table()), "the alarms that were, kept over restarts"));
    f.push_back(field_at<F>(
        "commands_per_cycle", [](F & m) -> auto& { return m.machine.commands_per_cycle; }, integer<std::uint8_t>(1, 64),
        "operator commands taken per cycle"));
    f.push_back(field("hmi", &F::hmi, section(hmi_table()), "state out, commands in"));
    f.push_back(views_field());
    f.push_back(field_at<F>(
        "simulation", [](F & m) -> auto& { return m.machine.simulation; }, section(simulation_table()), "used when the bus is simulated"));
    return table;
}

}  // namespace taktwerk::config
