// Conversations with a simulated slave's mailbox and what disturbs them, in virtual time.
#include "ecat/mailbox/mailbox_client.hpp"

#include <gmock/gmock.h>

#include "tests/ecat/coe/coe_bench.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

DeviceDescription drive_with_list() {
    auto d = sim::small_drive();
    d.mailbox->complete_access = true;
    for (std::uint8_t sub = 1; sub <= 40; ++sub) {
        ObjectEntry e;
        e.index = 0x3000, e.sub = sub, e.type = DataType::U32, e.value = 1000 + sub;
        d.objects.push_back(e);
    }
    return d;
}

Bytes text(std::size_t length) {
    Bytes bytes(length);
    for (std::size_t i = 0; i < length; ++i) bytes[i] = static_cast<std::byte>('a' + i % 26);
    return bytes;
}

// The drive falls while a parameter is written: its emergency stands in the mailbox before the answer.
TEST(MailboxClient, AnEmergencyBetweenRequestAndAnswerIsKeptAndTheAnswerArrives) {
    CoeBench bench{sim::small_drive()};
    bench.model->on_write = Emergency{0x3220, 0x05, {}};

    const auto written = bench.download(0x6081, 0, bytes({1, 0, 0, 0}));

    ASSERT_TRUE(written) << written.error().text();
    ASSERT_THAT(bench.log.entries(), SizeIs(1));
    EXPECT_EQ(bench.log.entries()[0].slave, 5u);
    EXPECT_EQ(bench.log.entries()[0].emergency.code, 0x3220);
    EXPECT_GT(bench.log.entries()[0].at, Instant{});
    EXPECT_EQ(bench.mailbox.emergency.load(), 0x0005'3220u);
}

TEST(MailboxClient, Code0000TakesTheEmergencyBack) {
    CoeBench bench{sim::small_drive()};
    bench.model->raise({0x3220, 0x05, {}});
    bench.model->raise({0x0000, 0x00, {}});

    ASSERT_TRUE(bench.run(read_unasked(*bench.port, bench.mailbox)));

    EXPECT_THAT(bench.log.entries(), SizeIs(2));
    EXPECT_EQ(bench.mailbox.emergency.load(), 0u);
}

TEST(MailboxClient, TheLogKeepsTheNewestHundred) {
    EmergencyLog log;
    for (std::uint16_t n = 1; n <= 130; ++n) log.keep({0, {}, {n, 0, {}}});
    ASSERT_THAT(log.entries(), SizeIs(100));
    EXPECT_EQ(log.entries().front().emergency.code, 31);
    EXPECT_EQ(log.entries().back().emergency.code, 130);
    EXPECT_EQ(log.count(), 130u);
}

// Five requests, none answered: four stand in the slave, the fifth is not even written. Each gives up after 2 s.
TEST(MailboxClient, AFifthMessageWaitsWhileFourAreUnanswered) {
    CoeBench bench{sim::small_drive(), {.response_delay = 60s}};
    for (int i = 0; i < 4; ++i) EXPECT_EQ(bench.upload(0x6041, 0).error().code, "sdo.timeout");
    EXPECT_EQ(bench.mailbox.unanswered, 4);
    const auto counter = bench.mailbox.counter;

    const auto fifth = bench.upload(0x6041, 0);

    EXPECT_EQ(fifth.error().code, "sdo.mailbox");
    EXPECT_THAT(fifth.error().text(), HasSubstr("4 earlier requests are still unanswered"));
    EXPECT_EQ(bench.mailbox.counter, counter) << "nothing was sent";
}

// A program gives a request up; its answer comes when the next one waits for its own.
TEST(MailboxClient, AnswersOfAbandonedRequestsAreSkipped) {
    CoeBench bench{sim::small_drive(), {.response_delay = 50ms}};
    {
        std::optional<Result<Bytes>> never;
        Runner abandoned{keep(sdo_upload(*bench.port, bench.mailbox, 0x6041, 0), never)};
        for (int i = 0; i < 20; ++i) {
            bench.step();
            abandoned.step(bench.now);
            bench.pack();
        }
    }
    ASSERT_EQ(bench.mailbox.unanswered, 1);

    const auto type = bench.upload(0x1000, 0);

    ASSERT_TRUE(type) << type.error().text();
    EXPECT_EQ(*type, bytes({0x92, 0x01, 0x02, 0x00}));
    EXPECT_EQ(bench.mailbox.unanswered, 0);
}

// The slave hangs, a request times out; when it comes back its late answer is read out before the next request is written.
TEST(MailboxClient, ALateAnswerIsReadOutBeforeTheNextRequest) {
    CoeBench bench{sim::small_drive()};
    bench.slave->stick_mailbox(true);
    EXPECT_EQ(bench.upload(0x6041, 0).error().code, "sdo.timeout");
    bench.slave->stick_mailbox(false);

    const auto type = bench.upload(0x1000, 0);

    ASSERT_TRUE(type) << type.error().text();
    EXPECT_EQ(*type, bytes({0x92, 0x01, 0x02, 0x00}));
}

TEST(MailboxClient, ARequestThatIsNeverAnsweredIsForgottenAfterTenSeconds) {
    CoeBench bench{sim::small_drive()};
    bench.slave->stick_mailbox(true);
    EXPECT_FALSE(bench.upload(0x6041, 0));
    bench.mailbox.unanswered = bench.mailbox.max_pending;
    for (int i = 0; i < 10'000; ++i) bench.step();
    bench.slave->stick_mailbox(false);

    EXPECT_TRUE(bench.upload(0x6041, 0));
}

// Of 250 bytes a mailbox of 128 carries 112 with the first message, then 119, then 19. One frame after the other is lost, each
// in a transfer of its own: on the way out (the slave saw nothing) or on the way back (the slave acted).
class LostFrame : public testing::TestWithParam<std::size_t CoeBench::*> {
protected:
    /// Runs the transfer without loss, then once for each of its frames.
    template <class Transfer>
    void each_frame(const DeviceDescription& description, Transfer transfer) {
        std::size_t frames = 0;
        for (std::size_t lost = 0; lost <= frames; ++lost) {
            CoeBench bench{description};
            bench.*GetParam() = lost;
            SCOPED_TRACE("frame " + std::to_string(lost) + " is lost");
            transfer(bench);
            if (lost == 0) frames = bench.frames;
            if (HasFatalFailure()) return;
        }
        EXPECT_GE(frames, 6u) << "three messages of two frames each: request and reading";
    }
};

TEST_P(LostFrame, DoesNotBreakASegmentedUpload) {
    const Bytes expected = text(250);
    each_frame(sim::small_drive(), [&](CoeBench& bench) {
        std::string value;
        for (const auto b : expected) value.push_back(static_cast<char>(b));
        bench.slave->dictionary().find(0x2001, 0)->set_text(value);

        const auto read = bench.upload(0x2001, 0);

        ASSERT_TRUE(read) << read.error().text();
        EXPECT_EQ(*read, expected);
    });
}

TEST_P(LostFrame, DoesNotBreakASegmentedDownload) {
    each_frame(sim::small_drive(), [&](CoeBench& bench) {
        const auto written = bench.download(0x2001, 0, text(250));

        ASSERT_TRUE(written) << written.error().text();
        const auto& stored = bench.slave->dictionary().find(0x2001, 0)->text();
        ASSERT_EQ(stored.size(), 250u);
        for (std::size_t i = 0; i < stored.size(); ++i) ASSERT_EQ(stored[i], static_cast<char>('a' + i % 26)) << i;
    });
}

// The fragments of an answer are messages that nobody asks for one by one.
TEST_P(LostFrame, DoesNotBreakAnObjectList) {
    auto description = sim::small_drive();
    description.mailbox->sdo_info = true;
    for (std::uint16_t n = 0; n < 150; ++n) {
        ObjectEntry e;
        e.index = static_cast<std::uint16_t>(0x3000 + n);
        description.objects.push_back(e);
    }
    each_frame(description, [&](CoeBench& bench) {
        const auto list = bench.run(list_objects(*bench.port, bench.mailbox, ObjectList::all));

        ASSERT_TRUE(list) << list.error().text();
        EXPECT_THAT(*list, SizeIs(171));
        EXPECT_TRUE(std::is_sorted(list->begin(), list->end()));
    });
}

INSTANTIATE_TEST_SUITE_P(Ways, LostFrame, testing::Values(&CoeBench::lose_request, &CoeBench::lose_answer),
                         [](const auto& way) { return way.index == 0 ? "OnTheWayOut" : "OnTheWayBack"; });

// Complete access: 40 entries of 4 bytes in one transfer.
TEST(SdoList, IsReadByCompleteAccessWhereTheSlaveCan) {
    CoeBench bench{drive_with_list()};
    bench.mailbox.complete_access = true;

    const auto list = bench.run(sdo_upload_list(*bench.port, bench.mailbox, 0x3000, 4));

    ASSERT_TRUE(list) << list.error().text();
    ASSERT_THAT(*list, SizeIs(40));
    EXPECT_EQ((*list)[39], bytes({0x10, 0x04, 0, 0})) << "1040";
    EXPECT_TRUE(bench.mailbox.complete_access);
    EXPECT_LT(bench.frames, 10u) << "162 bytes: two messages";
}

// The slave says it can and refuses: abort 06010004h. Entry by entry then, and not tried again.
TEST(SdoList, ARefusedCompleteAccessFallsBackToTheEntries) {
    auto description = drive_with_list();
    description.mailbox->complete_access = false;
    CoeBench bench{description};
    bench.mailbox.complete_access = true;

    const auto list = bench.run(sdo_upload_list(*bench.port, bench.mailbox, 0x3000, 4));

    ASSERT_TRUE(list) << list.error().text();
    ASSERT_THAT(*list, SizeIs(40));
    EXPECT_EQ((*list)[0], bytes({0xE9, 0x03, 0, 0})) << "1001";
    EXPECT_FALSE(bench.mailbox.complete_access);
}

// The entries of this object are two bytes wider than the caller believes: the sizes do not fit each other, so the bytes are not
// cut up at wrong places.
TEST(SdoList, ACompleteAnswerOfAnotherSizeIsNotBelieved) {
    CoeBench bench{drive_with_list()};
    bench.mailbox.complete_access = true;

    const auto list = bench.run(sdo_upload_list(*bench.port, bench.mailbox, 0x3000, 2));

    ASSERT_TRUE(list) << list.error().text();
    EXPECT_EQ((*list)[0], bytes({0xE9, 0x03, 0, 0})) << "the entry itself says how long it is";
    EXPECT_FALSE(bench.mailbox.complete_access);
}

TEST(SdoList, AMappingIsWrittenAtOnceOrEntryByEntry) {
    for (const bool complete : {true, false}) {
        auto description = drive_with_list();
        description.mailbox->complete_access = complete;
        CoeBench bench{description};
        bench.mailbox.complete_access = true;
        const std::vector<Bytes> entries{bytes({0x08, 0, 0x60, 0x60}), bytes({0x20, 0, 0x7A, 0x60})};

        const auto written = bench.run(sdo_download_list(*bench.port, bench.mailbox, 0x1600, entries));

        ASSERT_TRUE(written) << written.error().text();
        EXPECT_EQ(bench.slave->dictionary().value(0x1600, 0), 2);
        EXPECT_EQ(bench.slave->dictionary().value(0x1600, 1), 0x60600008);
        EXPECT_EQ(bench.slave->dictionary().value(0x1600, 2), 0x607A0020);
        EXPECT_EQ(bench.mailbox.complete_access, complete);
    }
}

// A dead slave is not asked forty more questions.
TEST(SdoList, SilenceIsNotARefusal) {
    CoeBench bench{drive_with_list()};
    bench.mailbox.complete_access = true;
    bench.slave->stick_mailbox(true);
    const Instant before = bench.now;

    EXPECT_EQ(bench.run(sdo_upload_list(*bench.port, bench.mailbox, 0x3000, 4)).error().code, "sdo.timeout");

    EXPECT_NEAR(to_seconds(bench.now - before), 2.0, 0.1);
    EXPECT_TRUE(bench.mailbox.complete_access);
}

// Emergencies without end, and the answer never: the wait for it ends all the same.
TEST(MailboxClient, ASlaveThatTalksWithoutEndAndAnswersNothingIsGivenUp) {
    CoeBench bench{sim::small_drive()};
    bench.slave->answer_after(1h);
    std::optional<Result<Bytes>> value;
    Runner reader{keep(sdo_upload(*bench.port, bench.mailbox, 0x1000, 0), value)};
    const Instant began = bench.now;
    for (int i = 0; i < 10'000 && !reader.done(); ++i) {
        bench.model->raise({0x3220, 0x05, {}});
        bench.step();
        reader.step(bench.now);
        bench.pack();
    }
    ASSERT_TRUE(value);
    ASSERT_FALSE(*value);
    EXPECT_EQ(value->error().code, "sdo.timeout");
    EXPECT_LE(bench.now - began, sdo_timeout + 100ms);
}

}  // namespace
}  // namespace taktwerk::ecat::test
