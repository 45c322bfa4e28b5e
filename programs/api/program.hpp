#pragma once
// What a machine program is: a shared object built against the SDK that declares what it needs by name and is called each
// scan. FROZEN SHAPE (extend additively); the ABI hash of programs/api/abi.hpp guards it.
//
//   class Cell final : public taktwerk::Program {
//       void declare(taktwerk::Declaration& d) override {
//           x_ = d.axis("x");
//           start_ = d.input("start_button");
//           lamp_ = d.output("lamp_run");
//           speed_ = d.parameter("speed", {.value = 200, .minimum = 10, .maximum = 500, .unit = "mm/s", .doc = "transfer speed"});
//           d.monitor("step", step_, "", "step of the sequence");
//           d.retain("pieces", pieces_);
//           d.task<&Cell::scan>("main");
//       }
//       void scan(taktwerk::TaskContext& ctx) {
//           power_.Axis = x_; power_.Enable = true; power_(ctx);
//           ctx.set(lamp_, power_.Status);
//       }
//   };
//   TAKTWERK_PROGRAM(Cell)
//
// Threads: declare() is called once after loading, start() and stop() on the service side (they may allocate and log). A task
// function runs on its task's thread: a base task on the cycle thread. Tasks of one program at different divisors run on
// different threads; a member that both touch needs std::atomic.
//
// A task function must not block, allocate, do I/O or loop without a bound. A program is trusted native code: an endless loop in
// it stops the bus, and the drives' watchdogs are the reaction. An exception that leaves it stops the program and its axes.
//
// What a builder learns step by step stands in docs/programming.md.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "axes/axis/motion_context.hpp"
#include "axes/group/path_types.hpp"
#include "core/alarm.hpp"
#include "fb_library/block_type.hpp"
#include "programs/api/declared.hpp"
#include "programs/api/task_context.hpp"

namespace taktwerk {

using axes::AxisRef;

namespace detail {
template <class T>
inline constexpr bool is_array = false;
template <class T, std::size_t N>
inline constexpr bool is_array<std::array<T, N>> = true;
}  // namespace detail

/// Collects what a program needs. A name that the configuration lacks is an error that names it and the nearest one;
/// handles stay invalid then, and the program is not started.
class Declaration {
public:
    using TaskFunction = void (*)(void* program, TaskContext& context);

    virtual AxisRef axis(std::string_view name) = 0;
    /// A group of axes (`axis_groups` of the machine), for the blocks of PLCopen Part 4. They are called in a base task.
    virtual axes::GroupRef axis_group(std::string_view name) = 0;
    /// A program in G-code (`paths` of the machine), for MC_PathSelect.
    virtual axes::PathRef path(std::string_view name) = 0;
    /// A slave of the bus, for its objects: EC_SdoRead, EC_SdoWrite, ObjectFuture.
    virtual DeviceRef device(std::string_view name) = 0;
    virtual Input<bool> input(std::string_view name) = 0;
    virtual Output<bool> output(std::string_view name) = 0;
    virtual Input<std::int64_t> input_word(std::string_view name) = 0;
    virtual Output<std::int64_t> output_word(std::string_view name) = 0;
    /// In the unit of the point: 7.5 for 7.5 bar.
    Input<double> input_real(std::string_view name) { return {input_word(name).index}; }
    Output<double> output_real(std::string_view name) { return {output_word(name).index}; }
    virtual Parameter parameter(std::string_view name, const ParameterSpec& spec) = 0;

    // Tables that blocks and axes follow. The name is for messages. `room`: the most points it will ever have, when the program edits it
    // while the machine runs (TaskContext::tables); room is taken here, once. Points that cannot be used are an error of the machine
    // file's check; a table without points may be filled later.
    virtual axes::CamRef cam(std::string_view name, std::span<const axes::CamPoint> points, std::size_t room = 0) = 0;
    /// A cam of the machine file (`cams`). The program has it as a table of its own, whose points it may change.
    virtual axes::CamRef cam(std::string_view name) = 0;
    /// For MC_PositionProfile, MC_VelocityProfile, MC_AccelerationProfile.
    virtual axes::TimeTableRef time_table(std::string_view name, std::span<const axes::TimePoint> rows, std::size_t room = 0) = 0;
    /// For MC_DigitalCamSwitch: its switches, and options of the tracks 1, 2, ... (at most 32).
    virtual axes::CamSwitchRef cam_switches(std::string_view name, std::span<const axes::CamSwitch> switches, std::size_t room = 0) = 0;
    virtual axes::TrackRef tracks(std::string_view name, std::span<const axes::TrackOptions> options) = 0;

    // References for MC_ReadDigitalInput, MC_ReadDigitalOutput, MC_WriteDigitalOutput, MC_DigitalCamSwitch, MC_TouchProbe.
    /// A point of the machine.
    axes::InputRef input_ref(std::string_view name) { return {.point = input_word(name).index}; }
    axes::OutputRef output_ref(std::string_view name) { return {.point = output_word(name).index}; }
    /// The digital inputs and outputs of an axis' drive.
    axes::InputRef drive_inputs(std::string_view axis_name) { return {.axis = axis(axis_name)}; }
    axes::OutputRef drive_outputs(std::string_view axis_name) { return {.axis = axis(axis_name)}; }
    /// One bit of an input of the machine as a trigger: rising edge, unless `falling` is set in what is returned. Triggers of the drive
    /// itself need no declaration: `TriggerRef{.source = TriggerSource::probe1}`.
    axes::TriggerRef trigger_input(std::string_view name, std::uint8_t bit = 0) {
        return {.source = axes::TriggerSource::input, .point = input_word(name).index, .bit = bit};
    }

    /// `number` 0..63; reaction as in core/alarm.hpp. An alarm that is raised but not declared is not shown.
    virtual void alarm(std::uint8_t number, Reaction reaction, std::string_view english, std::string_view chinese,
                       std::string_view remedy) = 0;

    /// Shows a variable to operators, the live view and traces. It is read by address while the machine runs, so it must be a member
    /// of the program (or of one of its blocks: `d.monitor("timer", grip_.ET)`), of exactly one of these types.
    // clang-format off
    void monitor(std::string_view name, const bool& v, std::string_view unit = {}, std::string_view doc = {}) { add(name, VariableType::boolean, &v, unit, doc); }
    void monitor(std::string_view name, const std::int32_t& v, std::string_view unit = {}, std::string_view doc = {}) { add(name, VariableType::int32, &v, unit, doc); }
    void monitor(std::string_view name, const std::int64_t& v, std::string_view unit = {}, std::string_view doc = {}) { add(name, VariableType::int64, &v, unit, doc); }
    void monitor(std::string_view name, const std::uint16_t& v, std::string_view unit = {}, std::string_view doc = {}) { add(name, VariableType::uint16, &v, unit, doc); }
    void monitor(std::string_view name, const std::uint32_t& v, std::string_view unit = {}, std::string_view doc = {}) { add(name, VariableType::uint32, &v, unit, doc); }
    void monitor(std::string_view name, const double& v, std::string_view unit = {}, std::string_view doc = {}) { add(name, VariableType::real, &v, unit, doc); }
    void monitor(std::string_view name, const Duration& v, std::string_view unit = {}, std::string_view doc = {}) { add(name, VariableType::duration, &v, unit, doc); }
    // clang-format on

    // A variable that a person may write, from the machine's own page (docs/views.md), over the socket or LCM. It is monitored as well. What was
    // written stands in it from the beginning of the next scan of its task on, and does not change within a scan; what the program writes to it
    // stands, too, and is what people see. While the program does not run it is written at once.
    // clang-format off
    /// A number: speed, length, count.
    void operator_value(std::string_view name, std::int32_t& v, const OperatorValueSpec& spec) { add_operator_value(name, VariableType::int32, &v, spec, OperatorValueKind::value); }
    void operator_value(std::string_view name, std::int64_t& v, const OperatorValueSpec& spec) { add_operator_value(name, VariableType::int64, &v, spec, OperatorValueKind::value); }
    void operator_value(std::string_view name, std::uint16_t& v, const OperatorValueSpec& spec) { add_operator_value(name, VariableType::uint16, &v, spec, OperatorValueKind::value); }
    void operator_value(std::string_view name, std::uint32_t& v, const OperatorValueSpec& spec) { add_operator_value(name, VariableType::uint32, &v, spec, OperatorValueKind::value); }
    void operator_value(std::string_view name, double& v, const OperatorValueSpec& spec) { add_operator_value(name, VariableType::real, &v, spec, OperatorValueKind::value); }
    // clang-format on
    /// On until somebody (the program may) switches it off.
    void operator_switch(std::string_view name, bool& v, const OperatorValueSpec& spec = {}) {
        add_operator_value(name, VariableType::boolean, &v, spec, OperatorValueKind::toggle);
    }
    /// TRUE while a person holds it. It falls back when it is let go, and by itself when the page that held it says nothing more, its axes are
    /// stopped, the emergency stop is pressed or the program ends: a button on a screen is no enabling device all the same. Like an input it
    /// may be pressed for less than a slow task's period.
    void operator_button(std::string_view name, bool& v, const OperatorValueSpec& spec = {}) {
        add_operator_value(name, VariableType::boolean, &v, spec, OperatorValueKind::button);
    }

    /// Keeps a variable, an array, or a whole block over a time without power, where the machine file has `retain`. It is kept by name and type:
    /// an edited program finds what it still has, and what fits another type (DINT to LINT) is converted (docs/retain.md). It must be a member of
    /// the program, of a type that a pin may have. What was kept stands in it before start() and the first scan; a program that is new, or
    /// whose variable is, finds the value that its constructor gave. Written is what stands there between two scans, all of a program of the same
    /// one. `task`: whose variable it is, and who alone writes it; needed where it is not the base task's.
    /// Of a block its pins are kept, and while its type is the same all of it: a counter does not count an edge twice, a timer goes on at its ET,
    /// a command that was under way is CommandAborted. Handles (Axis) are not kept.
    template <class T>
    void retain(std::string_view name, T& v, std::string_view task = {}) {
        keep(RetainKind::retain, name, v, task);
    }
    template <class T>
    void persistent(std::string_view name, T& v, std::string_view task = {}) {
        keep(RetainKind::persistent, name, v, task);
    }

    /// Anything else would be converted into a temporary whose address is kept: an enumeration, a float, a short, a sum.
    template <class T>
    void monitor(std::string_view name, const T& v, std::string_view unit = {}, std::string_view doc = {}) = delete;
    template <class T>
    void monitor(std::string_view name, const T&& v, std::string_view unit = {}, std::string_view doc = {}) = delete;

    /// Gives an instance a name, so that people are told who moves or locks an axis: `d.block("pick", pick_)`. It must be a member of the
    /// program (or of one of its parts), as for monitor().
    template <class Block>
    void block(std::string_view name, const Block& instance) {
        add_block(name, &instance, sizeof(Block));
    }
    template <class Block>
    void block(std::string_view name, const Block&& instance) = delete;

    /// A task by the name under which the configuration schedules it: `d.task<&Cell::scan>("main")`. The method is
    /// `void scan(taktwerk::TaskContext&)`, noexcept or not. A task that the configuration does not mention runs in each cycle.
    template <auto Method>
    void task(std::string_view name) {
        add_task(name, &call<Method>);
    }

protected:
    ~Declaration() = default;
    virtual void add(std::string_view name, VariableType type, const void* address, std::string_view unit, std::string_view doc) = 0;
    virtual void add_task(std::string_view name, TaskFunction function) = 0;
    virtual void add_block(std::string_view name, const void* begin, std::size_t size) = 0;
    virtual void add_operator_value(std::string_view name, VariableType type, void* address, const OperatorValueSpec& spec,
                                    OperatorValueKind kind) = 0;
    virtual void add_retained(RetainKind kind, std::string_view name, const fb::PinType& type, void* address, std::string_view task) = 0;
    virtual void add_retained_block(RetainKind kind, std::string_view name, const fb::BlockType& type, void* address,
                                    std::string_view task) = 0;

private:
    template <class T>
    void keep(RetainKind kind, std::string_view name, T& v, std::string_view task) {
        static_assert(!std::is_const_v<T>, "what is kept is written at the start: it cannot be const");
        if constexpr (detail::is_array<T>) {
            for (std::size_t i = 0; i < v.size(); ++i) keep(kind, std::string(name) + "[" + std::to_string(i) + "]", v[i], task);
        } else if constexpr (fb::HasPins<T>) {
            static constexpr fb::BlockType type = fb::block_type<T>();
            add_retained_block(kind, name, type, &v, task);
        } else {
            static_assert(
                requires { fb::PinTypeOf<T>::value; },
                "kept are types that a pin may have (bool, std::int32_t, double, Duration, ...), arrays of them, and blocks");
            constexpr auto pin = fb::PinTypeOf<T>::value.kind;
            static_assert(pin != fb::PinKind::AXIS_REF && pin != fb::PinKind::DEVICE_REF && pin != fb::PinKind::HANDLE,
                          "a handle means nothing after a restart: declare it again");
            static_assert(pin != fb::PinKind::STRUCT, "keep its members one by one");
            add_retained(kind, name, fb::PinTypeOf<T>::value, &v, task);
        }
    }
    template <class P>
    struct Class;
    template <class P>
    struct Class<void (P::*)(TaskContext&)> {
        using type = P;
    };
    template <class P>
    struct Class<void (P::*)(TaskContext&) noexcept> {
        using type = P;
    };
    template <auto Method>
    static void call(void* program, TaskContext& context);
};

/// One instance per program of the machine file; it lives from loading until the machine is gone.
class Program {
public:
    virtual ~Program() = default;
    /// Called once after loading, before there is a bus. Names are resolved here; nothing else is to be done here. An exception is
    /// an error of the machine file's check.
    virtual void declare(Declaration& declaration) = 0;
    /// The operator started the program (also after a fault was reset): put the sequence to its beginning. The first scan follows
    /// when this has returned.
    virtual void start() {}
    /// After the last scan: its axes are already stopping. For files and logs.
    virtual void stop() {}
};

template <auto Method>
void Declaration::call(void* program, TaskContext& context) {
    using P = typename Class<decltype(Method)>::type;
    (static_cast<P*>(static_cast<Program*>(program))->*Method)(context);
}

}  // namespace taktwerk
