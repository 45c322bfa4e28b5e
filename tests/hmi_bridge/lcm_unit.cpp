// The LCM side: what is published, which commands are taken, what hostile messages do.
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <limits>

#include "hmi_bridge/hmi_bridge.hpp"
#include "hmi_bridge/lcm/lcm_bus.hpp"
#include "hmi_bridge/lcm/memory_bus.hpp"
#include "taktwerk_lcm/acknowledge_v1_t.hpp"
#include "taktwerk_lcm/alarm_list_v1_t.hpp"
#include "taktwerk_lcm/axis_holder_v1_t.hpp"
#include "taktwerk_lcm/axis_state_v1_t.hpp"
#include "taktwerk_lcm/command_event_v1_t.hpp"
#include "taktwerk_lcm/command_v1_t.hpp"
#include "taktwerk_lcm/cycle_statistics_v1_t.hpp"
#include "taktwerk_lcm/heartbeat_v1_t.hpp"
#include "taktwerk_lcm/io_state_v1_t.hpp"
#include "taktwerk_lcm/machine_state_v1_t.hpp"
#include "taktwerk_lcm/program_values_v1_t.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using namespace taktwerk_lcm;
using runtime::Answer;
using test::FakeMachine;
using testing::HasSubstr;

constexpr std::int64_t wall = 1'800'000'000'000'000;  // us since 1970

template <class Message>
std::vector<std::byte> encoded(const Message& message) {
    std::vector<std::byte> bytes(static_cast<std::size_t>(message.getEncodedSize()));
    EXPECT_EQ(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size()));
    return bytes;
}

template <class Message>
std::vector<Message> decoded(const MemoryBus& bus, const std::string& channel) {
    std::vector<Message> out;
    for (const auto& message : bus.published) {
        if (message.channel != channel) continue;
        out.emplace_back();
        EXPECT_EQ(out.back().decode(message.bytes.data(), 0, static_cast<int>(message.bytes.size())),
                  static_cast<int>(message.bytes.size()));
    }
    return out;
}

command_v1_t command(std::int64_t seq, std::int32_t kind, std::string_view target = "") {
    command_v1_t c;
    std::memset(&c, 0, sizeof c);
    c.utime = wall;
    c.seq = seq;
    c.protocol_version = 1;
    c.command_kind = kind;
    c.client_id = 4711;
    c.valid_for_ms = 200;
    std::memcpy(c.target, target.data(), target.size());
    return c;
}

class LcmTest : public testing::Test {
protected:
    void open(HmiConfig config, std::unique_ptr<MessageBus> other = nullptr) {
        static int counter = 0;
        config.socket =
            (std::filesystem::temp_directory_path() / ("taktwerk-lcm-test-" + std::to_string(::getpid()) + "-" + std::to_string(counter++)))
                .string();
        auto memory = std::make_unique<MemoryBus>();
        bus = other ? nullptr : memory.get();
        auto opened = HmiBridge::open(config, machine,
                                      {.log = {}, .wall_utime = [] { return wall; }, .bus = other ? std::move(other) : std::move(memory)});
        ASSERT_TRUE(opened) << opened.error().text();
        bridge = std::move(opened).value();
    }
    static HmiConfig commanded() {
        HmiConfig config;
        config.lcm_commands = LcmCommands::local;
        return config;
    }
    void send(const command_v1_t& c) { bus->publish("TAKTWERK_DEMO_COMMAND", encoded(c)); }
    std::vector<acknowledge_v1_t> acknowledges() { return decoded<acknowledge_v1_t>(*bus, "TAKTWERK_DEMO_ACKNOWLEDGE"); }
    void step() { bridge->step(now += 5ms); }

    /// One datagram each; but the whole state is one message, whatever its size.
    void expect_small_messages() const {
        for (const auto& message : bus->published) {
            if (message.channel == "TAKTWERK_DEMO_WHOLE_STATE") continue;
            EXPECT_LE(message.bytes.size(), Publisher::message_size_aim) << message.channel;
        }
    }

    FakeMachine machine;
    MemoryBus* bus = nullptr;
    std::unique_ptr<HmiBridge> bridge;
    Instant now{1s};
};

TEST_F(LcmTest, TheStateIsPublishedAtItsRate) {
    open({});
    // 50 Hz by default: 50 messages in a second of 5 ms steps.
    for (int i = 0; i < 200; ++i) step();

    EXPECT_EQ(decoded<machine_state_v1_t>(*bus, "TAKTWERK_DEMO_MACHINE_STATE").size(), 50u);
    EXPECT_EQ(decoded<axis_state_v1_t>(*bus, "TAKTWERK_DEMO_AXIS_STATE").size(), 150u);
    EXPECT_EQ(decoded<io_state_v1_t>(*bus, "TAKTWERK_DEMO_IO_STATE").size(), 50u);
    EXPECT_EQ(decoded<program_values_v1_t>(*bus, "TAKTWERK_DEMO_PROGRAM_VALUES").size(), 50u);
    EXPECT_EQ(decoded<cycle_statistics_v1_t>(*bus, "TAKTWERK_DEMO_CYCLE_STATISTICS").size(), 5u);
    EXPECT_EQ(decoded<alarm_list_v1_t>(*bus, "TAKTWERK_DEMO_ALARM_LIST").size(), 2u);
    EXPECT_EQ(decoded<heartbeat_v1_t>(*bus, "TAKTWERK_DEMO_HEARTBEAT").size(), 10u);
    expect_small_messages();
}

TEST_F(LcmTest, AServiceThatWasHeldUpDoesNotCatchUpInABurst) {
    open({});
    step();
    const auto before = bus->published.size();
    now += 10s;
    step();
    const auto late = bus->published.size();
    // Each channel once, whatever was missed: machine, three axes and who holds them, i/o, values, the whole state, statistics,
    // alarms, heartbeat.
    EXPECT_EQ(late - before, 13u);
    step();
    EXPECT_EQ(bus->published.size(), late) << "nothing is made up for";
    now += 20ms;
    step();
    EXPECT_GT(bus->published.size(), late) << "and it goes on at its rate";
}

TEST_F(LcmTest, AnAxisCarriesTheValuesOfAnOnlinePage) {
    open({});
    auto& y = machine.snapshot.axes[1];
    y.state = axes::AxisState::DiscreteMotion;
    y.powered = y.homed = y.online = true;
    y.actual_position = 99.5;
    y.set_position = 100;
    y.set_velocity = -20;
    y.target_position = 40;
    y.active = 3;
    y.following_error = -0.25;
    machine.snapshot.following_peaks = {{}, {-0.75, 0.5}, {}};
    step();
    now += 50ms;
    step();

    const auto all = decoded<axis_state_v1_t>(*bus, "TAKTWERK_DEMO_AXIS_STATE");
    ASSERT_EQ(all.size(), 6u);
    const auto& m = all[4];
    EXPECT_EQ(m.utime, wall);
    EXPECT_EQ(m.protocol_version, 1);
    EXPECT_EQ(m.name, "y");
    EXPECT_EQ(m.unit, "mm");
    EXPECT_EQ(m.axis_index, 1);
    EXPECT_EQ(m.axis_count, 3);
    EXPECT_EQ(m.state, axis_state_v1_t::STATE_DISCRETE_MOTION);
    EXPECT_EQ(m.actual_position, 99.5);
    EXPECT_EQ(m.distance_to_go, -60) << "target minus set position";
    EXPECT_EQ(m.following_error, -0.25);
    EXPECT_EQ(m.following_error_min, -0.75) << "of all cycles, not of those that were published";
    EXPECT_EQ(m.following_error_max, 0.5);
    EXPECT_TRUE(m.negative_direction && m.constant_velocity && m.has_job && m.homed);
    EXPECT_FALSE(m.positive_direction || m.not_moving || m.disabled);
    EXPECT_TRUE(all[5].disabled);
    EXPECT_GT(all[5].seq, all[4].seq);
}

TEST_F(LcmTest, LongListsComeInSeveralMessages) {
    machine.its_layout.inputs.clear();
    for (int i = 0; i < 70; ++i) machine.its_layout.inputs.push_back("in_" + std::to_string(i));
    machine.snapshot.inputs.assign(70, 0);
    machine.snapshot.inputs[69] = 5;
    machine.snapshot.alarms.resize(30);
    for (std::size_t i = 0; i < 30; ++i) machine.snapshot.alarms[i].fact.id = static_cast<AlarmId>(100 + i);
    machine.snapshot.alarm_count = 30;
    open({});
    step();

    const auto io = decoded<io_state_v1_t>(*bus, "TAKTWERK_DEMO_IO_STATE");
    ASSERT_EQ(io.size(), 3u);  // 71 points, 32 a message
    EXPECT_EQ(io[2].first, 64);
    EXPECT_EQ(io[2].total, 71);
    EXPECT_EQ(io[2].value[5], 5);
    EXPECT_EQ(io[2].name[6], "lamp_run");
    EXPECT_EQ(io[2].output[6], 1);

    const auto alarms = decoded<alarm_list_v1_t>(*bus, "TAKTWERK_DEMO_ALARM_LIST");
    ASSERT_GT(alarms.size(), 1u);
    std::int32_t next = 0;
    for (const auto& page : alarms) {
        EXPECT_EQ(page.revision, 1);
        EXPECT_EQ(page.total, 30);
        EXPECT_EQ(page.first, next);
        for (const auto& alarm : page.alarm) EXPECT_EQ(alarm.id, 100 + next++);
    }
    EXPECT_EQ(next, 30);
    expect_small_messages();
}

// Who holds an axis and what makes it slow are there over LCM as in the state; a change comes with the next step.
TEST_F(LcmTest, WhoHoldsAnAxisIsPublishedAtEachChange) {
    open({});
    const auto of_x = [&] {
        std::vector<axis_holder_v1_t> out;
        for (auto& message : decoded<axis_holder_v1_t>(*bus, "TAKTWERK_DEMO_AXIS_HOLDER"))
            if (message.name == "x") out.push_back(std::move(message));
        return out;
    };
    bridge->step(now);
    ASSERT_EQ(of_x().size(), 1u);
    EXPECT_EQ(of_x()[0].held_by_stop, 0);
    std::array<std::byte, 8> hold{};
    machine.its_layout.blocks = {{"cell.hold", hold.data(), hold.size()}};
    machine.snapshot.axes[0].owner = axes::Owner::program;
    machine.snapshot.axes[0].holder = hold.data();
    machine.snapshot.axes[0].lock = 9;
    machine.snapshot.axes[0].limiter = axes::VelocityLimiter::manual_speed;
    bridge->step(now += 1ms);
    bridge->step(now += 1ms);
    ASSERT_EQ(of_x().size(), 2u) << "one for the change, none without";
    EXPECT_EQ(of_x()[1].owner, "program");
    EXPECT_EQ(of_x()[1].block, "cell.hold");
    EXPECT_NE(of_x()[1].held_by_stop, 0);
    EXPECT_EQ(of_x()[1].velocity_limiter, "manual_speed");
}

TEST_F(LcmTest, ARefusedCommandIsPublishedOnceAndItsCountLater) {
    open({});
    bridge->step(now);
    auto& event = machine.snapshot.events[0];
    event.number = 5;
    event.given = {axes::CommandKind::move_absolute, axes::Owner::program, 0, nullptr};
    event.error = axes::ErrorId::not_homed;
    machine.snapshot.event_count = 1;
    for (int i = 0; i < 10; ++i) {
        event.times += 1;
        bridge->step(now += 1ms);
    }
    auto told = decoded<command_event_v1_t>(*bus, "TAKTWERK_DEMO_COMMAND_EVENT");
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0].number, 5);
    EXPECT_EQ(told[0].event, "refused");
    EXPECT_EQ(told[0].axis, "x");
    EXPECT_EQ(told[0].command, "MC_MoveAbsolute");
    EXPECT_EQ(told[0].program, "cell");
    EXPECT_EQ(told[0].error, "not_homed");
    EXPECT_THAT(told[0].english, HasSubstr("MC_MoveAbsolute of program cell was refused"));
    bridge->step(now += 500ms);
    told = decoded<command_event_v1_t>(*bus, "TAKTWERK_DEMO_COMMAND_EVENT");
    ASSERT_EQ(told.size(), 2u);
    EXPECT_EQ(told[1].times, 11);
}

// A command to a group has the group's name where an axis has its own, and the words of groups for who ended it.
TEST_F(LcmTest, ACommandOfAGroupNamesTheGroup) {
    open({});
    bridge->step(now);
    auto& event = machine.snapshot.events[0];
    event.number = 5;
    event.what = runtime::CommandEvent::What::aborted;
    event.axis = axes::AxisRef{}.index;
    event.group = 0;
    event.given = {axes::CommandKind::none, axes::Owner::program, 0, nullptr, axes::GroupCommandKind::linear_absolute};
    event.by = {axes::CommandKind::none, axes::Owner::program, 1, nullptr, axes::GroupCommandKind::halt};
    machine.snapshot.event_count = 1;
    bridge->step(now += 1ms);
    const auto told = decoded<command_event_v1_t>(*bus, "TAKTWERK_DEMO_COMMAND_EVENT");
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0].axis, "table");
    EXPECT_EQ(told[0].command, "MC_MoveLinearAbsolute");
    EXPECT_EQ(told[0].by_command, "MC_GroupHalt");
    EXPECT_EQ(told[0].by_program, "feeder");
    EXPECT_THAT(told[0].english,
                HasSubstr("group table: MC_MoveLinearAbsolute of program cell was aborted by MC_GroupHalt of program feeder"));
}

TEST_F(LcmTest, AChangedAlarmIsPublishedAtOnce) {
    open({});
    for (int i = 0; i < 3; ++i) step();
    const auto before = decoded<alarm_list_v1_t>(*bus, "TAKTWERK_DEMO_ALARM_LIST").size();
    machine.snapshot.alarms.resize(1);
    machine.snapshot.alarms[0].standing = true;
    machine.snapshot.alarm_count = 1;

    step();

    const auto lists = decoded<alarm_list_v1_t>(*bus, "TAKTWERK_DEMO_ALARM_LIST");
    ASSERT_EQ(lists.size(), before + 1);
    ASSERT_EQ(lists.back().alarm.size(), 1u);
    EXPECT_EQ(lists.back().alarm[0].chinese, "跟随误差过大");
    EXPECT_EQ(lists.back().alarm[0].remedy, "Free it");
}

TEST_F(LcmTest, BeforeTheFirstCycleThereIsOnlyAHeartbeat) {
    machine.cycling = false;
    open({});
    step();
    ASSERT_EQ(bus->published.size(), 1u);
    const auto heartbeat = decoded<heartbeat_v1_t>(*bus, "TAKTWERK_DEMO_HEARTBEAT");
    ASSERT_EQ(heartbeat.size(), 1u);
    EXPECT_EQ(heartbeat[0].cycling, 0);
    EXPECT_EQ(heartbeat[0].commands_taken, 0);
}

TEST_F(LcmTest, ACommandIsCarriedOutAndAcknowledged) {
    open(commanded());
    auto c = command(1, command_v1_t::KIND_JOG, "y");
    c.value = -20;
    c.press = 1;
    send(c);
    step();

    ASSERT_EQ(machine.submitted.size(), 1u);
    EXPECT_EQ(machine.submitted[0].action, runtime::OperatorAction::jog);
    EXPECT_EQ(machine.submitted[0].axis, 1);
    EXPECT_EQ(machine.submitted[0].value, -20);
    EXPECT_EQ(machine.submitted[0].expires, now + 200ms);
    machine.answer(Answer::refused_by_axis, axes::ErrorId::not_powered);
    step();

    const auto answers = acknowledges();
    ASSERT_EQ(answers.size(), 1u);
    EXPECT_EQ(answers[0].client_id, 4711);
    EXPECT_EQ(answers[0].command_seq, 1);
    EXPECT_EQ(answers[0].answer, acknowledge_v1_t::ANSWER_REFUSED_BY_AXIS);
    EXPECT_EQ(answers[0].axis_error, 2);  // not_powered
    EXPECT_EQ(answers[0].code, "command.refused_by_axis");
    EXPECT_EQ(answers[0].subject, "axis y");
    EXPECT_THAT(answers[0].remedy, HasSubstr("Enable"));
}

TEST_F(LcmTest, ARepeatedCommandIsAcknowledgedAgainAndExecutedOnce) {
    open(commanded());
    send(command(1, command_v1_t::KIND_HOME, "x"));
    step();
    machine.answer(Answer::accepted);
    step();
    send(command(1, command_v1_t::KIND_HOME, "x"));
    step();

    EXPECT_EQ(machine.submitted.size(), 1u);
    EXPECT_EQ(acknowledges().size(), 2u);
}

TEST_F(LcmTest, WithoutPermissionNoCommandIsHeard) {
    open({});
    send(command(1, command_v1_t::KIND_HOME, "x"));
    step();
    EXPECT_TRUE(machine.submitted.empty());
    EXPECT_TRUE(acknowledges().empty());

    bridge.reset();
    open(commanded());  // the same message, permitted
    send(command(1, command_v1_t::KIND_HOME, "x"));
    step();
    EXPECT_EQ(machine.submitted.size(), 1u);
}

TEST_F(LcmTest, AStaleCommandIsRefused) {
    open(commanded());
    auto c = command(1, command_v1_t::KIND_HOME, "x");
    c.utime = wall - 200'001;
    send(c);
    c = command(2, command_v1_t::KIND_HOME, "x");
    c.utime = std::numeric_limits<std::int64_t>::max();
    send(c);
    step();
    EXPECT_TRUE(machine.submitted.empty());
    ASSERT_EQ(acknowledges().size(), 2u);
    for (const auto& answer : acknowledges()) EXPECT_EQ(answer.answer, acknowledge_v1_t::ANSWER_STALE);
}

TEST_F(LcmTest, ValuesOutOfRangeAndUnknownKindsAreRefused) {
    open(commanded());
    auto c = command(1, command_v1_t::KIND_JOG, "x");
    c.value = std::numeric_limits<double>::quiet_NaN();
    c.press = 1;
    send(c);
    send(command(2, static_cast<std::int32_t>(command_words.size()) + 1, "x"));
    send(command(3, -1, "x"));
    c = command(4, command_v1_t::KIND_HOME, "x");
    c.valid_for_ms = -1;
    send(c);
    send(command(5, command_v1_t::KIND_HOME, "z9"));
    step();
    EXPECT_TRUE(machine.submitted.empty());
    const auto answers = acknowledges();
    ASSERT_EQ(answers.size(), 5u);
    EXPECT_EQ(answers[0].answer, acknowledge_v1_t::ANSWER_BAD_VALUE);
    EXPECT_EQ(answers[1].answer, acknowledge_v1_t::ANSWER_UNKNOWN_NAME);
    EXPECT_EQ(answers[2].answer, acknowledge_v1_t::ANSWER_UNKNOWN_NAME);
    EXPECT_EQ(answers[3].answer, acknowledge_v1_t::ANSWER_BAD_VALUE);
    EXPECT_EQ(answers[4].answer, acknowledge_v1_t::ANSWER_UNKNOWN_NAME);
}

TEST_F(LcmTest, HostileMessagesAreDroppedAndCounted) {
    open(commanded());
    const auto good = encoded(command(1, command_v1_t::KIND_HOME, "x"));
    std::vector<std::vector<std::byte>> hostile;
    for (std::size_t size = 0; size < good.size(); ++size)
        hostile.emplace_back(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    hostile.push_back(good);
    hostile.back().push_back(std::byte{0});
    hostile.emplace_back(100'000, std::byte{0xFF});
    hostile.push_back(good);
    hostile.back()[0] ^= std::byte{1};  // fingerprint
    // The attack on variable types: another type's fingerprint with a count of 0x7fffffff, in a message of our size.
    axis_state_v1_t other{};
    auto foreign = encoded(other);
    foreign.resize(good.size());
    std::fill(foreign.begin() + 8, foreign.end(), std::byte{0x7F});
    hostile.push_back(foreign);
    const auto with = [](auto change) {
        auto c = command(1, command_v1_t::KIND_HOME, "x");
        change(c);
        return encoded(c);
    };
    hostile.push_back(with([](auto& c) { c.protocol_version = 2; }));
    hostile.push_back(with([](auto& c) { c.client_id = 0; }));
    hostile.push_back(with([](auto& c) { c.seq = 0; }));
    hostile.push_back(with([](auto& c) { c.seq = -5; }));
    hostile.push_back(with([](auto& c) { c.utime = -1; }));
    hostile.push_back(with([](auto& c) { c.press = 2; }));
    hostile.push_back(with([](auto& c) { c.mode = 3; }));
    hostile.push_back(with([](auto& c) { c.mode = 256; }));  // would be manual when cut to a byte
    hostile.push_back(with([](auto& c) { std::memset(c.target, 'x', sizeof c.target); }));
    hostile.push_back(with([](auto& c) { c.target[40] = 'y'; }));  // two names in one field

    for (const auto& message : hostile) {
        bus->publish("TAKTWERK_DEMO_COMMAND", message);
        step();
    }

    EXPECT_TRUE(machine.submitted.empty());
    EXPECT_TRUE(acknowledges().empty());
    EXPECT_EQ(bridge->lcm_rejected(), hostile.size());
    bus->publish("TAKTWERK_DEMO_COMMAND", good);
    step();
    EXPECT_EQ(machine.submitted.size(), 1u) << "and the next good one is taken";
}

TEST_F(LcmTest, AFloodOfClientIdsDoesNotLockOutOrGrow) {
    open(commanded());
    for (std::int64_t id = 1; id <= 1000; ++id) {
        auto c = command(1, command_v1_t::KIND_ACKNOWLEDGE);
        c.client_id = id;
        send(c);
        if (id % 50 == 0) step();
    }
    for (int i = 0; i < 20; ++i) step();
    EXPECT_EQ(machine.submitted.size(), LcmCommandReceiver::max_clients);
    EXPECT_EQ(bridge->lcm_rejected(), 1000 - LcmCommandReceiver::max_clients);

    now += LcmCommandReceiver::idle_client;
    auto late = command(1, command_v1_t::KIND_ACKNOWLEDGE);
    late.client_id = 5000;
    send(late);
    step();
    EXPECT_EQ(machine.submitted.size(), LcmCommandReceiver::max_clients + 1);
}

TEST_F(LcmTest, CommandsGoThroughRealLcmInMemory) {
    auto opened = LcmBus::open(*parse_lcm_url("memq://"));
    ASSERT_TRUE(opened) << opened.error().text();
    auto* lcm = opened->get();
    std::vector<acknowledge_v1_t> answers;
    lcm->subscribe("TAKTWERK_DEMO_ACKNOWLEDGE", [&](std::span<const std::byte> bytes) {
        answers.emplace_back();
        answers.back().decode(bytes.data(), 0, static_cast<int>(bytes.size()));
    });
    open(commanded(), std::move(opened).value());

    lcm->publish("TAKTWERK_DEMO_COMMAND", encoded(command(1, command_v1_t::KIND_HOME, "x")));
    lcm->publish("TAKTWERK_DEMO_COMMAND", std::vector<std::byte>(3));
    step();
    ASSERT_EQ(machine.submitted.size(), 1u);
    machine.answer(Answer::accepted);
    step();
    step();

    ASSERT_EQ(answers.size(), 1u);
    EXPECT_EQ(answers[0].answer, acknowledge_v1_t::ANSWER_ACCEPTED);
    EXPECT_EQ(bridge->lcm_rejected(), 1u);
}

TEST_F(LcmTest, AHandlerThatThrowsDoesNotThrowThroughLcm) {
    auto opened = LcmBus::open(*parse_lcm_url("memq://"));
    ASSERT_TRUE(opened);
    (*opened)->subscribe("C", [](std::span<const std::byte>) { throw std::runtime_error("no"); });
    (*opened)->publish("C", std::vector<std::byte>(3));
    EXPECT_NO_THROW((*opened)->poll(10));
}

/// Lowers a limit of this process for its lifetime.
class Limited {
public:
    Limited(__rlimit_resource what, rlim_t to) : what_(what) {
        ::getrlimit(what_, &before_);
        rlimit lower = before_;
        lower.rlim_cur = to;
        ::setrlimit(what_, &lower);
    }
    ~Limited() { ::setrlimit(what_, &before_); }
    Limited(const Limited&) = delete;
    Limited& operator=(const Limited&) = delete;

private:
    __rlimit_resource what_;
    rlimit before_{};
};

// The library would end the process.
TEST(LcmBusOpen, WithoutDescriptorsItIsAnErrorAndNotTheEndOfTheProcess) {
    const int next = ::dup(STDIN_FILENO);
    ::close(next);
    {
        const Limited few{RLIMIT_NOFILE, static_cast<rlim_t>(next) + 4};
        const auto refused = LcmBus::open(*parse_lcm_url("memq://"));
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, "hmi.lcm");
        EXPECT_THAT(refused.error().remedy, HasSubstr("ulimit -n"));
    }
    EXPECT_TRUE(LcmBus::open(*parse_lcm_url("memq://")));
}

}  // namespace
}  // namespace taktwerk::hmi
