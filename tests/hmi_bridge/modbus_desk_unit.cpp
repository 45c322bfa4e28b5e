// The machine's side of the Modbus TCP server: what each value shows, and how a write becomes a command and its answer an exception.
#include "hmi_bridge/modbus/modbus_desk.hpp"

#include <unistd.h>

#include <filesystem>

#include <gmock/gmock.h>

#include "hmi_bridge/hmi_bridge.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"
#include "tests/modbus/server/raw_client.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using modbus::server::NumberType;
using modbus::server::ServedRegister;
using modbus::server::Table;
using modbus::server::testing::framed;
using modbus::server::testing::RawBytes;
using modbus::server::testing::RawClient;
using Of = ShownValue::Of;
using What = ShownValue::What;
using runtime::Answer;
using runtime::OperatorAction;
using ::testing::HasSubstr;

ModbusPoint shown(const char* name, Table table, std::uint16_t address, NumberType type, ShownValue value, bool writable = false) {
    ModbusPoint point;
    point.place.name = name, point.place.table = table, point.place.address = address, point.place.type = type,
    point.place.writable = writable;
    point.shows = std::move(value);
    return point;
}

/// FakeMachine with an analog output, and a desk whose server the test steps.
class ModbusDeskTest : public testing::Test {
protected:
    ModbusDeskTest() {
        machine.its_layout.outputs = {"lamp_run", "valve"};
        machine.its_layout.output_units = {"", "%"};
        machine.its_layout.input_units = {"", ""};
        machine.snapshot.outputs = {1, 0};
        machine.snapshot.output_values = {1, 45.5};
        machine.snapshot.input_values = {{0, true}, {1, false}};
        machine.snapshot.alarms.resize(4);
        machine.snapshot.at = now;
        gateway.observe(true);
        config.server.listen.port = 0;
        auto valve = shown("valve", Table::holding, 0, NumberType::uint16, {Of::output, What::value, "valve"}, true);
        valve.scaled = true, valve.unit = "%", valve.factor = 10;
        config.points = {valve, shown("lamp", Table::coil, 0, NumberType::boolean, {Of::output, What::value, "lamp_run"}, true),
                         shown("speed", Table::holding, 1, NumberType::float32, {Of::parameter, What::value, "cell.speed"}, true),
                         shown("beat", Table::input, 0, NumberType::uint16, {Of::machine, What::heartbeat, {}}),
                         shown("step", Table::input, 1, NumberType::uint16, {Of::variable, What::value, "cell.step"})};
    }
    void open() {
        auto opened = ModbusDesk::open(config, names_of(machine.its_layout), gateway, {});
        ASSERT_TRUE(opened) << opened.error().text();
        desk = std::move(opened).value();
        client = std::make_unique<RawClient>(desk->server().port());
    }
    /// One round of the service side and of the server.
    void step() {
        machine.snapshot.cycle += 1;
        machine.snapshot.at = now;
        gateway.step(now);
        desk->step(&machine.snapshot, now);
        while (const auto reply = gateway.next_reply()) desk->deliver(*reply);
        desk->step(&machine.snapshot, now);
        desk->server().step(now);
        now += 1ms;
    }
    RawBytes answer_within(int steps) {
        RawBytes answer;
        for (int i = 0; i < steps && answer.empty(); ++i) {
            step();
            answer = client->take();
        }
        return answer;
    }
    RawBytes ask(const RawBytes& pdu) {
        client->send(framed(pdu));
        return answer_within(20);
    }
    /// Writes, and lets the machine answer each command that comes with `verdict`.
    RawBytes write(const RawBytes& pdu, Answer verdict) {
        client->send(framed(pdu));
        RawBytes answer;
        for (int i = 0; i < 200 && answer.empty(); ++i) {
            const auto before = machine.submitted.size();
            step();
            for (auto n = before; n < machine.submitted.size(); ++n)
                machine.answers.push_back({machine.submitted[n].client, machine.submitted[n].sequence, verdict});
            answer = client->take();
        }
        return answer;
    }

    test::FakeMachine machine;
    std::vector<std::string> log;
    Gateway gateway{machine, [this](std::string_view line) { log.emplace_back(line); }};
    ModbusServerConfig config;
    std::unique_ptr<ModbusDesk> desk;
    std::unique_ptr<RawClient> client;
    Instant now{50s};
};

TEST_F(ModbusDeskTest, AfterEachCycleItsValuesAreWhatClientsRead) {
    open();
    machine.snapshot.cycle = 69'999;
    step();
    EXPECT_EQ(ask({3, 0, 0, 0, 1}), framed({3, 2, 0x01, 0xC7})) << "45.5 % in tenths";
    const auto beat = static_cast<std::uint16_t>(machine.snapshot.cycle + 1 - 65536);
    EXPECT_EQ(ask({4, 0, 0, 0, 2}), framed({4, 4, static_cast<std::uint8_t>(beat >> 8), static_cast<std::uint8_t>(beat & 0xFF), 0, 7}))
        << "the heartbeat goes on where its register ends";
    machine.snapshot.output_values[1] = 7;
    EXPECT_EQ(ask({3, 0, 0, 0, 1}), framed({3, 2, 0, 70}));
}

TEST_F(ModbusDeskTest, AWriteIsTheCommandOfAPersonAndItsAnswerTheEcho) {
    open();
    EXPECT_EQ(write({6, 0, 0, 0x01, 0xC7}, Answer::accepted), framed({6, 0, 0, 0x01, 0xC7}));
    ASSERT_EQ(machine.submitted.size(), 1u);
    const auto& command = machine.submitted[0];
    EXPECT_EQ(command.action, OperatorAction::set_output);
    EXPECT_EQ(command.owner, axes::Owner::operator_panel);
    EXPECT_EQ(command.index, 1);
    EXPECT_DOUBLE_EQ(command.value, 45.5);
    EXPECT_NE(command.client, 0u);
    ASSERT_EQ(log.size(), 1u) << "who did what";
    EXPECT_THAT(log[0], HasSubstr("Modbus client 127.0.0.1:"));
    EXPECT_THAT(log[0], HasSubstr("set_output output valve = 45.5"));

    EXPECT_EQ(write({16, 0, 1, 0, 2, 4, 0x43, 0x48, 0, 0}, Answer::accepted), framed({16, 0, 1, 0, 2})) << "4348 0000h is 200";
    ASSERT_EQ(machine.submitted.size(), 2u);
    EXPECT_EQ(machine.submitted[1].action, OperatorAction::set_parameter);
    EXPECT_EQ(machine.submitted[1].index, 0);
    EXPECT_DOUBLE_EQ(machine.submitted[1].value, 200);
}

struct Judged {
    Answer answer;
    std::uint8_t exception;
};
class ModbusDeskRefusal : public ModbusDeskTest, public testing::WithParamInterface<Judged> {};
TEST_P(ModbusDeskRefusal, IsAnException) {
    open();
    EXPECT_EQ(write({5, 0, 0, 0xFF, 0}, GetParam().answer), framed({0x85, GetParam().exception}));
}
INSTANTIATE_TEST_SUITE_P(Answers, ModbusDeskRefusal,
                         testing::Values(Judged{Answer::bad_value, 3}, Judged{Answer::wrong_mode, 4}, Judged{Answer::not_possible_now, 4},
                                         Judged{Answer::no_control, 4}, Judged{Answer::stale, 4}, Judged{Answer::refused_by_axis, 4},
                                         Judged{Answer::unknown_name, 2}));

TEST_F(ModbusDeskTest, AValueOutsideOfItsRangeNeverReachesTheCycle) {
    open();
    EXPECT_EQ(ask({16, 0, 1, 0, 2, 4, 0x47, 0xC3, 0x50, 0}), framed({0x90, 3})) << "47C3 5000h is 100000: cell.speed is 10 to 500";
    EXPECT_TRUE(machine.submitted.empty());
}

TEST_F(ModbusDeskTest, AFullInboxAndACycleWithoutAnAnswerAreFailures) {
    open();
    machine.inbox_size = 0;
    EXPECT_EQ(ask({5, 0, 0, 0xFF, 0}), framed({0x85, 4}));
    machine.inbox_size = 10;
    client->send(framed({5, 0, 0, 0xFF, 0}));
    EXPECT_TRUE(answer_within(1900).empty());
    EXPECT_EQ(answer_within(300), framed({0x85, 4})) << "after the gateway's 2 s";
}

// The service side stood still meanwhile: what was meant for then is not done now.
TEST_F(ModbusDeskTest, AWriteThatHasWaitedTooLongIsNotCarriedOut) {
    open();
    step();
    client->send(framed({5, 0, 0, 0xFF, 0}));
    for (int i = 0; i < 20; ++i) desk->server().step(now);
    now += 1100ms;
    EXPECT_EQ(answer_within(20), framed({0x85, 4}));
    EXPECT_TRUE(machine.submitted.empty());
}

// Several at once are several commands: what comes first stands, the first refusal ends it.
TEST_F(ModbusDeskTest, OfSeveralTheFirstRefusalIsTheAnswer) {
    config.points.clear();
    machine.its_layout.outputs.clear();
    for (int i = 0; i < 40; ++i) {
        const auto name = "o" + std::to_string(i);
        machine.its_layout.outputs.push_back(name);
        config.points.push_back(
            shown(name.c_str(), Table::coil, static_cast<std::uint16_t>(i), NumberType::boolean, {Of::output, What::value, name}, true));
    }
    machine.its_layout.output_units.assign(40, "");
    machine.snapshot.output_values.assign(40, 0);
    open();
    EXPECT_EQ(write({15, 0, 0, 0, 40, 5, 0xFF, 0, 0xFF, 0, 0xFF}, Answer::accepted), framed({15, 0, 0, 0, 40}));
    ASSERT_EQ(machine.submitted.size(), 40u);
    for (std::size_t i = 0; i < 40; ++i) {
        EXPECT_EQ(machine.submitted[i].index, i) << "in the order of their addresses";
        EXPECT_EQ(machine.submitted[i].value, i / 8 % 2 == 0 ? 1 : 0);
    }
    machine.submitted.clear();
    EXPECT_EQ(write({15, 0, 0, 0, 40, 5, 0xFF, 0, 0xFF, 0, 0xFF}, Answer::wrong_mode), framed({0x8F, 4}));
    EXPECT_LE(machine.submitted.size(), ModbusDesk::commands_at_once);
}

TEST_F(ModbusDeskTest, WhatAClientHasSetIsLetGoWhenItIsGone) {
    open();
    write({5, 0, 0, 0xFF, 0}, Answer::accepted);
    const auto who = machine.submitted.at(0).client;
    machine.submitted.clear();
    client.reset();
    for (int i = 0; i < 20 && machine.submitted.empty(); ++i) step();
    ASSERT_EQ(machine.submitted.size(), 1u);
    EXPECT_EQ(machine.submitted[0].action, OperatorAction::release_outputs);
    EXPECT_EQ(machine.submitted[0].client, who);
    EXPECT_EQ(gateway.client_count(), 0u);
}

TEST_F(ModbusDeskTest, WhoIsGoneWhileTheMachineThinksLeavesNothingBehind) {
    open();
    client->send(framed({5, 0, 0, 0xFF, 0}));
    for (int i = 0; i < 20 && machine.submitted.empty(); ++i) step();
    ASSERT_EQ(machine.submitted.size(), 1u);
    client.reset();
    machine.answer(Answer::accepted);
    for (int i = 0; i < 20; ++i) step();
    EXPECT_EQ(gateway.client_count(), 0u);
    EXPECT_EQ(machine.submitted.back().action, OperatorAction::release_outputs);
}

TEST_F(ModbusDeskTest, WhoOnlyReadsIsNoClientOfTheGateway) {
    open();
    ask({4, 0, 0, 0, 1});
    EXPECT_EQ(gateway.client_count(), 0u);
}

// The cycle stands: what the snapshot shows grows old, although the service side and the server go on.
TEST_F(ModbusDeskTest, ACycleThatStandsIsNotShownAsLive) {
    open();
    EXPECT_EQ(ask({3, 0, 0, 0, 1}).size(), 11u);
    const auto stood = [&](Duration time) {
        const auto end = now + time;
        for (; now < end; now += 1ms) {
            desk->step(&machine.snapshot, now);
            desk->server().step(now);
        }
        client->send(framed({3, 0, 0, 0, 1}));
        RawBytes answer;
        for (Patience patience; patience.lasts(answer.empty()); answer = client->take()) desk->server().step(now);
        return answer;
    };
    EXPECT_EQ(stood(190ms).size(), 11u);
    EXPECT_EQ(stood(20ms), framed({0x83, 4}));
    EXPECT_EQ(ask({3, 0, 0, 0, 1}).size(), 11u) << "it goes on";
}

TEST_F(ModbusDeskTest, BeforeTheFirstCycleThereIsNothingToRead) {
    open();
    client->send(framed({3, 0, 0, 0, 1}));
    RawBytes answer;
    for (Patience patience; patience.lasts(answer.empty()); answer = client->take()) {
        desk->step(nullptr, now);
        desk->server().step(now);
    }
    EXPECT_EQ(answer, framed({0x83, 4}));
}

TEST_F(ModbusDeskTest, AMachineThatDoesNotHaveTheNameDoesNotServe) {
    config.points.back().shows.name = "cell.stop";
    const auto opened = ModbusDesk::open(config, names_of(machine.its_layout), gateway, {});
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, "served.unknown_name");
}

// Where nobody else steps the server the bridge does.
TEST_F(ModbusDeskTest, TheBridgeServesWhatItsConfigurationOffers) {
    HmiConfig hmi;
    hmi.lcm = false;
    hmi.socket = (std::filesystem::temp_directory_path() / ("taktwerk-modbus-test-" + std::to_string(::getpid()))).string();
    {
        const auto none = HmiBridge::open(hmi, machine, {});
        ASSERT_TRUE(none) << none.error().text();
        EXPECT_EQ((*none)->modbus_server(), nullptr);
    }
    hmi.modbus_server = config;
    HmiOptions options;
    options.log = [this](std::string_view line) { log.emplace_back(line); };
    auto bridge = HmiBridge::open(hmi, machine, std::move(options));
    ASSERT_TRUE(bridge) << bridge.error().text();
    EXPECT_THAT(log, ::testing::Contains(HasSubstr("5 values are offered over Modbus TCP at 127.0.0.1:")));
    RawClient one{(*bridge)->modbus_server()->port()};
    const auto served = [&](const RawBytes& pdu) {
        one.send(framed(pdu));
        RawBytes answer;
        for (int i = 0; i < 20 && answer.empty(); ++i) {
            const auto before = machine.submitted.size();
            machine.snapshot.cycle += 1, machine.snapshot.at = now;
            (*bridge)->step(now);
            if (machine.submitted.size() > before) machine.answer(Answer::accepted);
            now += 1ms;
            answer = one.take();
        }
        return answer;
    };
    EXPECT_EQ(served({3, 0, 0, 0, 1}), framed({3, 2, 0x01, 0xC7}));
    EXPECT_EQ(served({5, 0, 0, 0xFF, 0}), framed({5, 0, 0, 0xFF, 0}));
    EXPECT_EQ(machine.submitted.size(), 1u);

    hmi.socket += "-second";
    hmi.modbus_server->server.listen.port = (*bridge)->modbus_server()->port();
    const auto second = HmiBridge::open(hmi, machine, {});
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, "served.listen");
}

// --- each value -------------------------------------------------------------------------------------------------------------------------

TEST_F(ModbusDeskTest, EachValueShowsItsOwnNumber) {
    auto& x = machine.snapshot.axes[1];  // y
    x.actual_position = 1.5, x.actual_velocity = -2.5, x.set_position = 3.5, x.set_velocity = 4.5, x.actual_torque = 0.25,
    x.following_error = 0.125;
    x.state = axes::AxisState::ErrorStop, x.error = 4711, x.powered = true, x.homed = false, x.in_position = true;
    machine.snapshot.phase = runtime::MachinePhase::stopping;
    machine.snapshot.mode = runtime::Mode::automatic;
    machine.snapshot.emergency_stop = true;
    machine.snapshot.alarm_count = 3;
    machine.snapshot.alarms[0] = {{1, AlarmSource::axis, 0}, {}, 1, true};
    machine.snapshot.alarms[1] = {{2, AlarmSource::axis, 1}, {}, 1, false};  // waits for acknowledgement
    machine.snapshot.alarms[2] = {{3, AlarmSource::slave, 1}, {}, 1, true};
    const auto names = names_of(machine.its_layout);
    const auto number = [&](Of of, What what, const char* name) {
        const auto bound = bind({of, what, name}, names);
        EXPECT_TRUE(bound) << name;
        return value_of(*bound, ServedRegister{}, machine.snapshot);
    };
    EXPECT_EQ(number(Of::axis, What::position, "y"), 1.5);
    EXPECT_EQ(number(Of::axis, What::velocity, "y"), -2.5);
    EXPECT_EQ(number(Of::axis, What::set_position, "y"), 3.5);
    EXPECT_EQ(number(Of::axis, What::set_velocity, "y"), 4.5);
    EXPECT_EQ(number(Of::axis, What::torque, "y"), 0.25);
    EXPECT_EQ(number(Of::axis, What::following_error, "y"), 0.125);
    EXPECT_EQ(number(Of::axis, What::state, "y"), 7) << "as STATE_ERROR_STOP of axis_state_v1_t";
    EXPECT_EQ(number(Of::axis, What::error, "y"), 4711);
    EXPECT_EQ(number(Of::axis, What::powered, "y"), 1);
    EXPECT_EQ(number(Of::axis, What::homed, "y"), 0);
    EXPECT_EQ(number(Of::axis, What::in_position, "y"), 1);
    EXPECT_EQ(number(Of::axis, What::alarm, "x"), 1);
    EXPECT_EQ(number(Of::axis, What::alarm, "y"), 0) << "it does not stand any more, and slave 1 is no axis";
    EXPECT_EQ(number(Of::machine, What::alarm, ""), 1);
    EXPECT_EQ(number(Of::machine, What::alarms, ""), 2);
    EXPECT_EQ(number(Of::machine, What::phase, ""), 2) << "PHASE_STOPPING of machine_state_v1_t";
    EXPECT_EQ(number(Of::machine, What::mode, ""), 2);
    EXPECT_EQ(number(Of::machine, What::emergency_stop, ""), 1);
    EXPECT_EQ(number(Of::input, What::value, "estop_ok"), 1);
    EXPECT_EQ(number(Of::input, What::good, "estop_ok"), 0);
    EXPECT_EQ(number(Of::input, What::good, "start_button"), 1);
    EXPECT_EQ(number(Of::output, What::value, "valve"), 45.5);
    EXPECT_EQ(number(Of::variable, What::value, "cell.step"), 7);
    EXPECT_EQ(number(Of::parameter, What::value, "feeder.pause"), 2);
    EXPECT_EQ(bind({Of::axis, What::velocity, "y"}, names)->unit, "mm/s");
    EXPECT_FALSE(bind({Of::parameter, What::value, "pause"}, names)) << "with its program's name";
}

TEST_F(ModbusDeskTest, TheHeartbeatWrapsWhereItsTypeEnds) {
    const BoundValue beat{Of::machine, What::heartbeat, 0, {}};
    const auto shown_as = [&](NumberType type) {
        ServedRegister place;
        place.type = type;
        return value_of(beat, place, machine.snapshot);
    };
    machine.snapshot.cycle = 0x1'0000'0005;
    EXPECT_EQ(shown_as(NumberType::uint16), 5);
    EXPECT_EQ(shown_as(NumberType::uint32), 5);
    machine.snapshot.cycle = 0xFFFF'FFFF;
    EXPECT_EQ(shown_as(NumberType::uint16), 0xFFFF);
    EXPECT_EQ(shown_as(NumberType::int16), 0x7FFF);
    EXPECT_EQ(shown_as(NumberType::uint32), 0xFFFF'FFFF);
    EXPECT_EQ(shown_as(NumberType::int32), 0x7FFF'FFFF);
    EXPECT_EQ(shown_as(NumberType::float32), 0xFF'FFFF) << "the last that a float tells from its neighbour";
}

}  // namespace
}  // namespace taktwerk::hmi
