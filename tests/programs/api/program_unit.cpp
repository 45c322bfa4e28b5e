// What a program may rely on in programs/api/program.hpp.

#include "programs/api/program.hpp"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "fb_library/iec/counters.hpp"

namespace taktwerk {
namespace {

TEST(UnresolvedHandle, ReadsGiveZeroAndWritesDoNothing) {
    std::array<std::int64_t, 2> inputs{7, 7}, outputs{5, 5};
    std::array<double, 1> parameters{3};
    TaskContext ctx;
    ctx.inputs = inputs;
    ctx.outputs = outputs;
    ctx.parameters = parameters;

    ctx.set(Output<bool>{}, true);
    ctx.set(Output<std::int64_t>{}, 9);
    ctx.set(Output<bool>{2}, true);  // one beyond the last

    EXPECT_FALSE(ctx.get(Input<bool>{}));
    EXPECT_EQ(ctx.get(Input<std::int64_t>{}), 0);
    EXPECT_EQ(ctx.get(Input<std::int64_t>{2}), 0);
    EXPECT_FALSE(ctx.get(Output<bool>{}));
    EXPECT_EQ(ctx.get(Output<std::int64_t>{}), 0);
    EXPECT_EQ(ctx.get(Parameter{}), 0.0);
    EXPECT_EQ(ctx.view(AxisRef{}), nullptr);
    EXPECT_EQ(outputs, (std::array<std::int64_t, 2>{5, 5}));
}

TEST(ResolvedHandle, ReadsAndWritesItsPoint) {
    std::array<std::int64_t, 2> inputs{0, -4}, outputs{0, 0};
    std::array<double, 2> parameters{1, 2.5};
    TaskContext ctx;
    ctx.inputs = inputs;
    ctx.outputs = outputs;
    ctx.parameters = parameters;

    ctx.set(Output<bool>{0}, true);
    ctx.set(Output<std::int64_t>{1}, -9);

    EXPECT_EQ(outputs, (std::array<std::int64_t, 2>{1, -9}));
    EXPECT_TRUE(ctx.get(Output<bool>{0}));
    EXPECT_EQ(ctx.get(Output<std::int64_t>{1}), -9);
    EXPECT_TRUE(ctx.get(Input<bool>{1}));
    EXPECT_EQ(ctx.get(Input<std::int64_t>{1}), -4);
    EXPECT_EQ(ctx.get(Parameter{1}), 2.5);
}

TEST(Alarm, IsABitThatFollowsItsConditionAlone) {
    TaskContext ctx;
    ctx.alarm(0, true);
    ctx.alarm(63, true);
    EXPECT_EQ(ctx.alarms, 0x8000000000000001u);
    ctx.alarm(0, false);
    EXPECT_EQ(ctx.alarms, 0x8000000000000000u);
}

// An address of a temporary must not be kept: what is not exactly one of the types does not compile.
enum Step : std::int32_t { first };
template <class T>
concept Monitored = requires(Declaration& d, T value) {
    d.monitor("name", std::forward<T>(value));
};
static_assert(Monitored<bool&> && Monitored<std::int32_t&> && Monitored<std::int64_t&> && Monitored<std::uint16_t&> &&
              Monitored<std::uint32_t&> && Monitored<double&> && Monitored<Duration&> && Monitored<const double&>);
static_assert(!Monitored<Step&> && !Monitored<float&> && !Monitored<std::int16_t&> && !Monitored<std::uint8_t&> &&
              !Monitored<std::chrono::seconds&>);
static_assert(!Monitored<double> && !Monitored<int> && !Monitored<bool>);

class Recorder final : public Declaration {
public:
    AxisRef axis(std::string_view) override { return {}; }
    axes::GroupRef axis_group(std::string_view) override { return {}; }
    axes::PathRef path(std::string_view) override { return {}; }
    DeviceRef device(std::string_view) override { return {}; }
    Input<bool> input(std::string_view) override { return {}; }
    Output<bool> output(std::string_view) override { return {}; }
    Input<std::int64_t> input_word(std::string_view) override { return {}; }
    Output<std::int64_t> output_word(std::string_view) override { return {}; }
    Parameter parameter(std::string_view, const ParameterSpec&) override { return {}; }
    axes::CamRef cam(std::string_view, std::span<const axes::CamPoint>, std::size_t) override { return {}; }
    axes::CamRef cam(std::string_view) override { return {}; }
    axes::TimeTableRef time_table(std::string_view, std::span<const axes::TimePoint>, std::size_t) override { return {}; }
    axes::CamSwitchRef cam_switches(std::string_view, std::span<const axes::CamSwitch>, std::size_t) override { return {}; }
    axes::TrackRef tracks(std::string_view, std::span<const axes::TrackOptions>) override { return {}; }
    void alarm(std::uint8_t, Reaction, std::string_view, std::string_view, std::string_view) override {}
    void add(std::string_view, VariableType, const void*, std::string_view, std::string_view) override {}
    void add_task(std::string_view, TaskFunction function) override { functions.push_back(function); }
    void add_block(std::string_view, const void*, std::size_t) override {}
    void add_operator_value(std::string_view, VariableType, void*, const OperatorValueSpec&, OperatorValueKind) override {}
    void add_retained(RetainKind kind, std::string_view name, const fb::PinType& type, void* address, std::string_view task) override {
        kept.push_back({kind, std::string(name), std::string(type.name), address, std::string(task)});
    }
    void add_retained_block(RetainKind kind, std::string_view name, const fb::BlockType& type, void* address,
                            std::string_view task) override {
        kept.push_back({kind, std::string(name), std::string(type.name), address, std::string(task)});
    }
    std::vector<TaskFunction> functions;
    struct Kept {
        RetainKind kind;
        std::string name, type;
        void* address;
        std::string task;
    };
    std::vector<Kept> kept;
};

/// With a second base before Program, the object and its Program part have different addresses.
struct Recipe {
    virtual ~Recipe() = default;
    int pieces = 1;
};
class TwoTasks final : public Recipe, public Program {
public:
    int fast = 0, slow = 0;
    void declare(Declaration& d) override {
        d.task<&TwoTasks::scan>("fast");
        d.task<&TwoTasks::careful>("slow");
    }
    void scan(TaskContext&) { fast += pieces; }
    void careful(TaskContext&) noexcept { slow += pieces; }
};

TEST(Task, CallsTheMethodOfTheProgramItBelongsTo) {
    Recorder recorder;
    TwoTasks program;
    static_cast<Program&>(program).declare(recorder);
    ASSERT_EQ(recorder.functions.size(), 2u);

    TaskContext ctx;
    for (auto function : recorder.functions) function(static_cast<Program*>(&program), ctx);

    EXPECT_EQ(program.fast, 1);
    EXPECT_EQ(program.slow, 1);
}

// Every member by its own name and type: an array element by element, a block as itself.
TEST(Retain, NamesEachMemberWithItsType) {
    Recorder recorder;
    std::int16_t number = 0;
    bool flag = false;
    Duration time{};
    std::array<float, 2> recipe{};
    fb::CTU count;
    Declaration& d = recorder;
    d.retain("number", number);
    d.persistent("flag", flag, "slow");
    d.retain("time", time);
    d.retain("recipe", recipe);
    d.persistent("count", count);
    ASSERT_EQ(recorder.kept.size(), 6u);
    const auto is = [&](std::size_t i, RetainKind kind, std::string_view name, std::string_view type, const void* address) {
        const auto& kept = recorder.kept[i];
        return kept.kind == kind && kept.name == name && kept.type == type && kept.address == address;
    };
    EXPECT_TRUE(is(0, RetainKind::retain, "number", "INT", &number));
    EXPECT_TRUE(is(1, RetainKind::persistent, "flag", "BOOL", &flag));
    EXPECT_EQ(recorder.kept[1].task, "slow");
    EXPECT_TRUE(is(2, RetainKind::retain, "time", "TIME", &time));
    EXPECT_TRUE(is(3, RetainKind::retain, "recipe[0]", "REAL", &recipe[0]));
    EXPECT_TRUE(is(4, RetainKind::retain, "recipe[1]", "REAL", &recipe[1]));
    EXPECT_TRUE(is(5, RetainKind::persistent, "count", "CTU", &count));
}

}  // namespace
}  // namespace taktwerk
