// Faults on demand: the language, and what each does to the bus. Expected values by hand from ETG.1000.4 and the commands' own
// description.

#include "ecat/sim/faults.hpp"

#include <gmock/gmock.h>

#include "ecat/sim/digital_terminal.hpp"
#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::sim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(FaultText, EveryCommandIsReadWithItsArguments) {
    const auto fault = [](std::string_view text) {
        const auto parsed = parse_fault(text);
        EXPECT_TRUE(parsed) << text << ": " << (parsed ? "" : parsed.error().text());
        return parsed ? *parsed : Fault{};
    };
    EXPECT_EQ(fault("unplug y_drive").slave, "y_drive");
    EXPECT_EQ(fault("power-cycle x").time, 500ms);
    EXPECT_EQ(fault("power-cycle x 2s").time, 2s);
    EXPECT_EQ(fault("drop 5").count, 5u);
    EXPECT_EQ(fault("  delay 3  1.5ms ").time, 1500us);
    EXPECT_EQ(fault("corrupt 1 0x70").bit, 0x70u);
    EXPECT_FALSE(fault("stick-mailbox x off").on);
    EXPECT_EQ(fault("refuse x SAFEOP 0x001D").al_code, 0x001D);
    EXPECT_EQ(fault("refuse x safeop off").state, EsmState::safeop);
    EXPECT_EQ(fault("abort x 6060:00 0x08000022").index, 0x6060);
    EXPECT_EQ(fault("abort x 0x1C12:1 0x08000022").sub, 1);
    EXPECT_EQ(fault("drift x -80").drift_ppm, -80.0);
    EXPECT_EQ(fault("drift x 50ppm").drift_ppm, 50.0);
    EXPECT_EQ(fault("clock-step x -10us").time, -10us);
    EXPECT_EQ(fault("after 2s plug x").after, 2s);
    for (const auto& command : fault_commands()) EXPECT_EQ(parse_fault(command.word).ok(), false) << command.word << " needs arguments";
}

TEST(FaultText, WhatIsWrongIsSaidWithWhatToWrite) {
    const auto problem = [](std::string_view text) {
        const auto parsed = parse_fault(text);
        return parsed ? std::string{"fine"} : parsed.error().text();
    };
    EXPECT_THAT(problem("unplugg y"), HasSubstr("did you mean 'unplug'?"));
    EXPECT_THAT(problem("drop"), HasSubstr("N is missing"));
    EXPECT_THAT(problem("drop"), HasSubstr("write: drop N"));
    EXPECT_THAT(problem("drop many"), HasSubstr("'many' is not N"));
    EXPECT_THAT(problem("drop 5 6"), HasSubstr("one word too many"));
    EXPECT_THAT(problem("delay 3 5"), HasSubstr("TIME"));
    EXPECT_THAT(problem("delay 3 -5ms"), HasSubstr("'-5ms' is not TIME")) << "an answer before its question";
    EXPECT_THAT(problem("power-cycle x -1s"), HasSubstr("'-1s' is not TIME"));
    EXPECT_THAT(problem("hang x maybe"), HasSubstr("on or off"));
    EXPECT_THAT(problem("refuse x BOOT 1"), HasSubstr("STATE"));
    EXPECT_THAT(problem("abort x zzzz 1"), HasSubstr("INDEX:SUB"));
    EXPECT_THAT(problem("after 2s"), HasSubstr("after 2s unplug"));
    EXPECT_THAT(problem(""), HasSubstr("empty"));
}

struct Faulty : testing::Test {
    Faulty() {
        x = &bus.add_drive({.name = "x"});
        y = &bus.add_drive({.name = "y"});
    }
    void fault(std::string_view text) {
        const auto parsed = parse_fault(text);
        ASSERT_TRUE(parsed) << parsed.error().text();
        const auto applied = injector.apply(*parsed, bus.now);
        ASSERT_TRUE(applied) << applied.error().text();
    }
    std::string refusal(std::string_view text) {
        const auto parsed = parse_fault(text);
        const auto applied = parsed ? injector.apply(*parsed, bus.now) : Result<void>{parsed.error()};
        return applied ? std::string{"fine"} : applied.error().text();
    }
    std::uint16_t count() { return bus.send(Command::BRD, Address::physical(0, 0), Bytes(1)).wkc; }
    BusProbe bus;
    FaultPlan cable;
    FaultInjector injector{bus.network, cable};
    SimSlave *x = nullptr, *y = nullptr;
};

TEST_F(Faulty, CablesAndPowerByName) {
    fault("unplug y");
    EXPECT_EQ(count(), 1);
    fault("plug y");
    EXPECT_EQ(count(), 2);
    fault("power-off x");
    EXPECT_EQ(count(), 0);
    fault("power-on x");
    EXPECT_EQ(count(), 2);
    fault("unplug master");
    EXPECT_TRUE(cable.link_down);
    EXPECT_EQ(count(), 0);
    fault("plug master");
    EXPECT_FALSE(cable.link_down);
    EXPECT_EQ(count(), 2);
}

TEST_F(Faulty, TheCableOfTheSecondInterfaceIsCalledRing) {
    (void)bus.network.close_ring(*y);
    EXPECT_TRUE(y->controller().ports().link(1));
    fault("unplug ring");
    EXPECT_FALSE(y->controller().ports().link(1));
    fault("plug ring");
    EXPECT_TRUE(y->controller().ports().link(1));
}

TEST_F(Faulty, APowerCycleBringsTheSlaveBackAfterItsTime) {
    bus.write(1, 0x0010, le<std::uint16_t>(0x1002));
    fault("power-cycle y 100ms");
    bus.wait(99ms);
    injector.step(bus.now);
    EXPECT_EQ(count(), 1);
    bus.wait(1ms);
    injector.step(bus.now);

    EXPECT_EQ(count(), 2);
    EXPECT_EQ(bus.value<std::uint16_t>(1, 0x0010), 0);
}

TEST_F(Faulty, AFaultMayWaitForItsTime) {
    fault("after 2s unplug y");
    fault("after 1s hang x on");
    EXPECT_EQ(injector.next_event(), bus.now + 1s);
    bus.wait(1999ms);
    injector.step(bus.now);
    EXPECT_EQ(count(), 2);
    bus.wait(1ms);
    injector.step(bus.now);
    EXPECT_EQ(count(), 1);
    EXPECT_EQ(injector.next_event(), never);
    EXPECT_THAT(refusal("after 1h unplug y"), HasSubstr("after")) << "hours are no unit here";
    EXPECT_THAT(refusal("after 1s unplug z"), HasSubstr("no such slave"));
}

TEST_F(Faulty, AnUnknownSlaveComesWithASuggestion) {
    bus.add_drive({.name = "lift_drive"});
    EXPECT_THAT(refusal("unplug lift_driv"), HasSubstr("did you mean 'lift_drive'?"));
    EXPECT_THAT(refusal("unplug gearbox"), HasSubstr("choose one of x, y, lift_drive"));
}

TEST_F(Faulty, NoiseIsCountedWhereItEntersAndByAllBehind) {
    fault("noise y 3");
    for (int i = 0; i < 3; ++i) {
        bus.send(Command::BWR, Address::physical(0, 0x0F80), bytes({static_cast<int>(i + 1)}));
        EXPECT_FALSE(bus.flight.has_value()) << "the network card throws it away";
    }
    EXPECT_EQ(count(), 2) << "over";

    EXPECT_EQ(x->controller().peek(0x0F80), std::byte{3}) << "before the damage it was good";
    EXPECT_EQ(y->controller().peek(0x0F80), std::byte{0});
    EXPECT_EQ(bus.value<std::uint16_t>(1, 0x0300), 0x0303) << "y, port 0: three invalid frames, three with bad symbols";
    EXPECT_EQ(bus.value<std::uint8_t>(1, 0x0308), 0);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0302), 0x0003) << "x, port 1: three invalid frames on their way back";
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0309), 3) << "and somebody before it had seen them";
    bus.write(0, 0x0300, bytes({0}));
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0302), 0);
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0309), 0);
}

TEST_F(Faulty, TheMailboxSticksLiesAndAborts) {
    bus.to_preop(0);
    fault("stick-mailbox x on");
    EXPECT_TRUE(bus.upload(0, 0x1000, 0).empty());
    fault("stick-mailbox x off");
    bus.wait(1ms);
    bus.read(0, 0x1400, 0x80);

    fault("abort x 1000:00 0x08000021");
    auto answer = bus.upload(0, 0x1000, 0);
    ASSERT_EQ(answer.size(), 10u);
    EXPECT_EQ(load_le<std::uint32_t>(answer, 6), 0x08000021u);
    fault("abort x 1000:00 off");
    answer = bus.upload(0, 0x1000, 0);
    ASSERT_EQ(answer.size(), 10u);
    EXPECT_EQ(load_le<std::uint32_t>(answer, 6), 0x00020192u);

    fault("wrong-length x 3");
    std::vector<std::uint16_t> lengths;
    for (int i = 0; i < 4; ++i) {
        Bytes request(0x80);
        const auto upload = bytes({10, 0, 0, 0, 0, 0x03 | ((i % 2 + 5) << 4), 0x00, 0x20, 0x40, 0x00, 0x10, 0x00});
        std::copy(upload.begin(), upload.end(), request.begin());
        bus.write(0, 0x1000, request);
        bus.wait(1ms);
        lengths.push_back(load_le<std::uint16_t>(bus.read(0, 0x1400, 0x80).data));
    }
    // 80h bytes of mailbox carry 7Ah after the header; the answer has 10.
    EXPECT_THAT(lengths, ElementsAre(0x7B, 9, 0, 10));
}

TEST_F(Faulty, StatesAreRefusedAndAddressesForgotten) {
    bus.mailboxes(0);
    fault("refuse x PREOP 0x0051");
    EXPECT_EQ(bus.request(0, 2), 0x11);
    EXPECT_EQ(bus.code(0), 0x0051);
    fault("refuse x PREOP off");
    EXPECT_EQ(bus.request(0, 0x12), 2);

    bus.write(0, 0x0010, le<std::uint16_t>(0x1001));
    fault("forget-address x");
    EXPECT_EQ(bus.send(Command::FPRD, Address::physical(0x1001, 0x0130), Bytes(2)).wkc, 0);
}

TEST(FaultyClock, DriftsAndJumps) {
    BusProbe bus;
    auto description = small_drive();
    description.dc.supported = true;
    bus.add_drive({.name = "x"}, description);
    FaultPlan cable;
    FaultInjector injector{bus.network, cable};
    const auto time = [&] { return bus.value<std::int64_t>(0, 0x0910) - 50; };
    bus.wait(1s);
    EXPECT_EQ(time(), 1'000'000'000);

    ASSERT_TRUE(injector.apply(*parse_fault("drift x 100"), bus.now));
    bus.wait(1s);
    EXPECT_EQ(time(), 2'000'100'000) << "100 us in a second";
    ASSERT_TRUE(injector.apply(*parse_fault("clock-step x -1ms"), bus.now));
    EXPECT_EQ(time(), 1'999'100'000);
}

TEST(FaultyCable, AnswersOvertakeEachOther) {
    // Given two frames on their way over a cable that reorders one answer
    BusProbe bus;
    bus.add_drive();
    LoopbackTransport transport{bus.network};
    transport.faults.reorder_answers = 1;
    const auto send = [&](std::uint8_t index, Instant now) {
        std::array<std::byte, max_frame_size> buffer{};
        FrameBuilder builder{buffer, MacAddress{}};
        builder.add(Command::BRD, index, Address::physical(0, 0), 1);
        EXPECT_TRUE(transport.send(builder.finish(), now));
    };
    std::vector<int> arrived;
    const auto receive = [&](Instant now) {
        std::array<std::byte, max_frame_size> buffer{};
        while (const auto frame = transport.receive(buffer, now)) {
            FrameReader reader{std::span<const std::byte>{buffer.data(), frame->size}};
            arrived.push_back(reader.next()->index);
        }
    };
    send(1, bus.now);
    receive(bus.now + 1ms);
    EXPECT_THAT(arrived, ElementsAre()) << "it waits for the next";

    send(2, bus.now + 1ms);
    send(3, bus.now + 2ms);
    receive(bus.now + 3ms);

    EXPECT_THAT(arrived, ElementsAre(2, 1, 3));
}

}  // namespace
}  // namespace taktwerk::ecat::sim
