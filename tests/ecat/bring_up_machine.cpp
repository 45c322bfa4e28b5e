// The whole way from an unknown bus to OP, against simulated slaves that answer only to frames.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/ecat/test_bus.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::HasSubstr;

class BringUpOf : public ::testing::TestWithParam<const char*> {};

TEST_P(BringUpOf, EndsInOpWithEverySlaveFreshAndSynchronised) {
    TestBus bus{GetParam()};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    bus.run_for(200ms);

    for (std::size_t i = 0; i < bus.config.slaves.size(); ++i) {
        EXPECT_EQ(bus.state(i), sim::EsmState::op) << i;
        EXPECT_TRUE(bus.master->health(i).fresh) << i;
        EXPECT_EQ(bus.master->health(i).al_state, AlState::op) << i;
    }
    EXPECT_EQ(bus.master->statistics().frames_lost, 0u);
    EXPECT_EQ(bus.master->statistics().working_counter_errors, 0u);
    EXPECT_LE(bus.now, Instant{} + 5s);
}

INSTANTIATE_TEST_SUITE_P(Lines, BringUpOf, ::testing::Values("s", "t", "ss", "st", "ts", "sts", "sstt"));

// 1 ms cycles; a register access takes two cycles, an SDO at least six. Hand estimate for one servo: under half a second,
// 100 ms of it the lead of SYNC0.
TEST(BringUp, RunsSideBySideSoThatEightSlavesTakeLittleLongerThanOne) {
    TestBus one{"s"}, eight{"ssssssss"};
    ASSERT_TRUE(one.bring_up());
    ASSERT_TRUE(eight.bring_up());
    EXPECT_LT(one.now, Instant{} + 500ms);
    EXPECT_LT(eight.now - one.now, 300ms);
}

TEST(BringUp, FindsSlavesByAliasWhereverTheyStand) {
    TestBus bus{"t"};
    sim::SlaveOptions options;
    options.alias = 77;
    bus.network.add(servo_description(), std::make_unique<EchoServo>(), options);
    SlaveConfig y;
    y.name = "y";
    y.device = servo_description();
    y.alias = 77;
    y.dc = true;
    bus.config.slaves.insert(bus.config.slaves.begin(), y);

    ASSERT_TRUE(bus.bring_up()) << bus.why();
    EXPECT_TRUE(bus.master->output(0, 0x607A, 0).ok());
    EXPECT_TRUE(bus.master->output(1, 0x7000, 8).ok());
}

TEST(BringUp, NamesExpectedAndFoundIdentity) {
    TestBus bus{"st"};
    auto other = servo_description();
    other->identity.product = 0x00001234;
    bus.config.slaves[0].device = other;

    EXPECT_FALSE(bus.bring_up());
    EXPECT_EQ(bus.master->failure().code, "bus.wrong_identity");
    EXPECT_EQ(bus.master->failure().subject, "slave 0 'a' (sv33-e)");
    EXPECT_THAT(bus.master->failure().what, HasSubstr("expected vendor 000007FBh product 00001234h"));
    EXPECT_THAT(bus.master->failure().what, HasSubstr("found vendor 000007FBh product 000C0108h"));
    EXPECT_EQ(bus.master->phase(), Master::Phase::failed);
}

TEST(BringUp, AcceptsTheFurtherIdentitiesOfAContradictoryManual) {
    TestBus bus{"s"};
    auto other = servo_description();
    other->also_accepted = {other->identity};
    other->identity.vendor = 0x00100000;
    bus.config.slaves[0].device = other;
    EXPECT_TRUE(bus.bring_up()) << bus.why();
}

TEST(BringUp, SaysWhichSlaveIsMissingAndBehindWhichTheCableEnds) {
    TestBus bus{"stt"};
    bus.network.set_power(2, false);
    EXPECT_FALSE(bus.bring_up());
    EXPECT_EQ(bus.master->failure().code, "bus.missing_slave");
    EXPECT_THAT(bus.master->failure().text(), HasSubstr("slave 'c' (dio8)"));
    EXPECT_THAT(bus.master->failure().text(), HasSubstr("the bus has 2 of 3"));
    EXPECT_THAT(bus.master->failure().remedy, HasSubstr("behind slave 1"));
}

TEST(BringUp, RefusesASlaveThatIsNotConfigured) {
    TestBus bus{"st"};
    bus.config.slaves.pop_back();
    EXPECT_FALSE(bus.bring_up());
    EXPECT_EQ(bus.master->failure().code, "bus.unexpected_slave");
    EXPECT_THAT(bus.master->failure().what, HasSubstr("product 00000808h"));
}

TEST(BringUp, OnAnEmptyOrDeadCableSaysWhatToCheck) {
    TestBus dead{"s"};
    dead.network.set_cable(0, false);
    EXPECT_FALSE(dead.bring_up());
    EXPECT_EQ(dead.master->failure().code, "bus.no_frame");
    EXPECT_THAT(dead.master->failure().remedy, HasSubstr("cable"));
}

TEST(BringUp, TellsStateCodeSizesAndRemedyOfARefusal) {
    TestBus bus{"ts"};
    bus.network.slave(1).refuse_state(sim::EsmState::safeop, 0x001D);
    EXPECT_FALSE(bus.bring_up());
    const auto& why = bus.master->failure();
    EXPECT_EQ(why.code, "bus.refused_state");
    EXPECT_EQ(why.subject, "slave 1 'b' (sv33-e)");
    EXPECT_THAT(why.what, HasSubstr("refused SAFEOP: 001Dh"));
    EXPECT_THAT(why.what, HasSubstr("SM2 is 6 bytes at 1800h, the slave maps 6; SM3 is 6 bytes at 1C00h, the slave maps 6"));
    EXPECT_THAT(why.what, HasSubstr("SYNC0 every 1 ms"));
    EXPECT_FALSE(why.remedy.empty());
}

// The profile says 1702h has 6040h, 607Ah; the drive's 1702h has 6060h between them.
TEST(BringUp, ComparesThePdoWithWhatTheSlaveReallyMaps) {
    TestBus bus{"s"};
    auto profile = servo_description();
    profile->rx_pdos[1].entries = {{0x6040, 0, 16}, {0x607A, 0, 32}};
    bus.config.slaves[0].device = profile;
    bus.config.slaves[0].rx.assigned = {{0x1702, true, {}}};
    EXPECT_FALSE(bus.bring_up());
    EXPECT_EQ(bus.master->failure().code, "bus.pdo_mismatch");
    EXPECT_THAT(bus.master->failure().what, HasSubstr("entry 2 of 1702h is 6060h:00/8 in the slave, configured is 607Ah:00/32"));
    EXPECT_THAT(bus.master->failure().what, HasSubstr("configured are 6 bytes, the slave has 7"));
}

TEST(BringUp, AssignsAndMapsVariablePdos) {
    TestBus bus{"s"};
    bus.config.slaves[0].rx.assigned = {{0x1600, false, {{0x6060, 0, 8}, {0x6040, 0, 16}, {0x607A, 0, 32}}}};
    bus.config.slaves[0].tx.assigned = {{0x1A00, false, {{0x6064, 0, 32}, {0x6041, 0, 16}}}};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    EXPECT_EQ(bus.master->output(0, 0x607A, 0).value().bit_offset, 24u);
    EXPECT_TRUE(bus.master->output(0, 0x607A, 0).value().is_signed);
    EXPECT_EQ(bus.network.slave(0).dictionary().value(0x1C12, 1), 0x1600);
    EXPECT_EQ(bus.network.slave(0).dictionary().value(0x1600, 3), 0x607A0020);
}

TEST(BringUp, WritesAndVerifiesStartupSdos) {
    TestBus bus{"s"};
    bus.config.slaves[0].startup.push_back({.at = Transition::PreopToSafeop,
                                            .index = 0x6085,
                                            .sub = 0,
                                            .type = DataType::U32,
                                            .value = 5000,
                                            .verify = true,
                                            .if_changed = false,
                                            .origin = "demo.yaml:31:7"});
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    EXPECT_EQ(bus.network.slave(0).dictionary().value(0x6085, 0), 5000);
}

TEST(BringUp, NamesObjectAbortAndOriginOfAStartupSdoThatIsRefused) {
    TestBus bus{"s"};
    bus.config.slaves[0].startup.push_back({.at = Transition::PreopToSafeop,
                                            .index = 0x6085,
                                            .sub = 0,
                                            .type = DataType::U32,
                                            .value = 2'000'000,
                                            .verify = true,
                                            .if_changed = false,
                                            .origin = "demo.yaml:31:7"});
    EXPECT_FALSE(bus.bring_up());
    EXPECT_EQ(bus.master->failure().code, "sdo.abort");
    EXPECT_THAT(bus.master->failure().text(), HasSubstr("slave 0 'a' (sv33-e): writing 6085h:00 was refused: abort 06090031h"));
    EXPECT_THAT(bus.master->failure().text(), HasSubstr("demo.yaml:31:7"));
}

TEST(BringUp, SurvivesLostFramesOnTheWay) {
    for (std::uint32_t at = 5; at < 300; at += 7) {
        TestBus bus{"st"};
        bus.start();
        bus.run_for(at * 1ms);
        bus.transport.faults.drop_answers = 2;
        bus.run_until([&] { return bus.master->phase() == Master::Phase::operational || bus.master->phase() == Master::Phase::failed; },
                      20s);
        EXPECT_EQ(bus.master->phase(), Master::Phase::operational) << "lost at " << at << " ms: " << bus.why();
    }
}

TEST(BringUp, IsRepeatableToTheNanosecond) {
    TestBus first{"sts"}, second{"sts"};
    ASSERT_TRUE(first.bring_up());
    ASSERT_TRUE(second.bring_up());
    EXPECT_EQ(first.now, second.now);
    EXPECT_EQ(first.servo(0).last_exchange, second.servo(0).last_exchange);
}

TEST(BringUp, CanStartAgainAfterAFailure) {
    TestBus bus{"s"};
    bus.network.set_power(0, false);
    EXPECT_FALSE(bus.bring_up());
    bus.network.set_power(0, true);
    EXPECT_TRUE(bus.bring_up()) << bus.why();
}

TEST(BringUp, NeedsACycleAndSaysSo) {
    TestBus bus{"t"};
    bus.start();
    // pump() only: acyclic datagrams reach SAFEOP, then process data is missing.
    for (int i = 0; i < 20'000 && bus.master->phase() != Master::Phase::failed; ++i) {
        bus.now += 1ms;
        bus.master->pump(bus.now);
        bus.master->step(bus.now);
    }
    EXPECT_EQ(bus.state(0), sim::EsmState::safeop);
    EXPECT_EQ(bus.master->failure().code, "bus.no_cycle");
}

TEST(TakeDown, EndsInInit) {
    TestBus bus{"st"};
    ASSERT_TRUE(bus.bring_up());
    bus.master->stop();
    ASSERT_TRUE(bus.run_until([&] { return bus.master->phase() == Master::Phase::stopped; }, 2s)) << bus.why();
    EXPECT_EQ(bus.state(0), sim::EsmState::init);
    EXPECT_EQ(bus.state(1), sim::EsmState::init);
    EXPECT_EQ(bus.servo(0).watchdogs, 0) << "an ordered stop is no watchdog";
    bus.run_for(20ms);
    const auto sent = bus.master->statistics().frames_sent;
    bus.run_for(10ms);
    EXPECT_EQ(bus.master->statistics().frames_sent, sent) << "nothing more is sent";
}

}  // namespace
}  // namespace taktwerk::ecat::test
