// "Why not OP" from facts alone: expected causes and texts by hand from ETG.1000.6 and ETG.1020.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ecat/bringup/refusal.hpp"

namespace taktwerk::ecat {
namespace {

using namespace std::chrono_literals;
using ::testing::Contains;
using ::testing::HasSubstr;

SyncManager outputs(std::uint16_t length) {
    SyncManager sm;
    sm.start = 0x1800, sm.length = length, sm.control = SyncManager::usual_outputs, sm.activate = SyncManager::enable;
    return sm;
}

/// A drive that refused SAFEOP although everything was as it should be.
Refusal refusal(std::uint16_t code) {
    Refusal r;
    r.subject = "slave 3 'y' (sv33-e)";
    r.asked = AlState::safeop;
    r.reached = AlState::preop;
    r.status = 0x12;
    r.code = code;
    r.clock.supported = r.clock.required = r.clock.configured = r.clock.started = true;
    r.clock.activation = std::uint8_t{0x03};
    r.clock.bus_cycle = 1ms;
    r.sync_managers = {{2, outputs(19), outputs(19), std::uint16_t{19}, std::uint16_t{0}}};
    return r;
}

// SM2 was set to 19 bytes; the slave still has a PDO of 12 assigned.
TEST(Refusal, NamesTheSyncManagerWhoseSizeTheMappingContradicts) {
    auto r = refusal(0x001D);
    r.sync_managers[0].mapping_bytes = 12;
    judge(r);
    EXPECT_EQ(r.cause, "SM2 is 19 bytes, the PDOs that the slave reports need 12");
    EXPECT_THAT(r.remedy, HasSubstr("pdo.rx"));
    const auto error = refusal_error(r);
    EXPECT_EQ(error.code, "bus.refused_state");
    EXPECT_EQ(error.subject, "slave 3 'y' (sv33-e)");
    EXPECT_THAT(error.what, HasSubstr("refused SAFEOP: 001Dh invalid output configuration (it is in PREOP)"));
    EXPECT_THAT(error.what, HasSubstr("SM2 is 19 bytes at 1800h, the slave maps 12"));
}

TEST(Refusal, NamesASyncManagerThatDoesNotHoldWhatWasWritten) {
    auto r = refusal(0x0017);
    r.sync_managers[0].found->length = 8;
    judge(r);
    EXPECT_THAT(r.cause, HasSubstr("SM2 does not hold"));
    EXPECT_THAT(fact_lines(r), Contains(HasSubstr("the controller holds 8 bytes at 1800h control 64h")));
}

TEST(Refusal, SaysThatSync0IsMissingWhereTheSlaveNeedsIt) {
    auto r = refusal(0x002D);
    r.clock.configured = false;
    judge(r);
    EXPECT_THAT(r.remedy, HasSubstr("dc: true"));

    r = refusal(0x002D);
    r.clock.started = false;
    judge(r);
    EXPECT_THAT(r.remedy, HasSubstr("sync_start"));

    r = refusal(0x0032);
    r.clock.difference_ns = 12'000;
    judge(r);
    EXPECT_THAT(r.cause, HasSubstr("12000 ns"));
}

// A firmware that hangs: SYNC0 is started on the way to SAFEOP, nobody in INIT waits for it.
TEST(Refusal, BelowSafeopSync0IsNoCause) {
    auto r = refusal(0);
    r.asked = AlState::preop, r.reached = AlState::init;
    r.timed_out = true;
    r.clock.started = false;
    judge(r);
    EXPECT_EQ(r.cause, "the slave neither takes the state nor says why");
    EXPECT_THAT(r.remedy, HasSubstr("power-cycle the slave"));
}

TEST(Refusal, NumbersAreWrittenAsAPersonWouldWriteThem) {
    auto r = refusal(0x0036);
    r.clock.sync0_cycle = 22'880ns;
    judge(r);
    EXPECT_EQ(r.cause, "the slave does not accept a SYNC0 cycle of 22.88 us");
}

TEST(Refusal, BlamesMissingOutputsOnlyWhileNoneAreExchanged) {
    auto r = refusal(0x0019);
    r.asked = AlState::op, r.reached = AlState::safeop;
    judge(r);
    EXPECT_THAT(r.cause, HasSubstr("no valid outputs"));
    r.valid_outputs = true;
    judge(r);
    EXPECT_EQ(r.cause, "no valid outputs");  // the standard's words for the code: nothing better is known
}

TEST(Refusal, RemembersTheSdoThatWasRefusedBefore) {
    auto r = refusal(0x0026);
    r.last_abort = "1C12h:01 abort 06090030h";
    judge(r);
    EXPECT_THAT(r.cause, HasSubstr("1C12h:01 abort 06090030h"));
    EXPECT_THAT(refusal_error(r).what, HasSubstr("last SDO abort: 1C12h:01"));
}

TEST(Refusal, ATimeoutSaysHowLongAndWhereTheSlaveStays) {
    auto r = refusal(0);
    r.timed_out = true;
    r.waited = 10s;
    r.status = 0x02;
    judge(r);
    const auto error = refusal_error(r);
    EXPECT_EQ(error.code, "bus.state_timeout");
    EXPECT_THAT(error.what, HasSubstr("did not reach SAFEOP within 10 s: it stays in PREOP without an error (AL status 0002h"));
    EXPECT_FALSE(error.remedy.empty());
}

TEST(Refusal, EveryCodeOfTheStandardHasACauseAndARemedy) {
    for (const auto& info : al_status_codes()) {
        auto r = refusal(info.code);
        judge(r);
        EXPECT_FALSE(r.cause.empty()) << info.code;
        EXPECT_FALSE(r.remedy.empty()) << info.code;
    }
}

}  // namespace
}  // namespace taktwerk::ecat
