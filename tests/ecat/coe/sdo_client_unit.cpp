// The SDO client against a mailbox that answers exactly what each test puts into it. Message bytes from ETG.1000.6.
#include "ecat/coe/sdo_client.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>

#include "ecat/transport/loopback.hpp"
#include "ecat/wire/mailbox.hpp"
#include "ecat/wire/registers.hpp"
#include "tests/ecat/coe/scripted_mailbox.hpp"

namespace taktwerk::ecat {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr auto out_start = test::ScriptedMailbox::out_start, in_start = test::ScriptedMailbox::in_start,
               box_size = test::ScriptedMailbox::box_size;
using Bytes = std::vector<std::byte>;

Bytes bytes(std::initializer_list<int> values) {
    Bytes result;
    for (const int v : values) result.push_back(static_cast<std::byte>(v));
    return result;
}

/// Replies wait in `script`; those of a request are put out when it comes.
class MailboxSlave final : public test::ScriptedMailbox {
public:
    struct Reply {
        MailboxType type = MailboxType::coe;
        Bytes payload;
    };
    std::deque<std::vector<Reply>> script;  ///< replies to the first, second, ... request
    std::vector<Bytes> requests;

private:
    void request(std::span<const std::byte> mailbox) override {
        requests.emplace_back(mailbox.begin(), mailbox.end());
        if (script.empty()) return;
        for (const auto& reply : script.front()) {
            Bytes message(box_size);
            std::copy(reply.payload.begin(), reply.payload.end(), message.begin() + mailbox_header_size);
            finish_mailbox(message, reply.type, 1, reply.payload.size());
            put_out(std::move(message));
        }
        script.pop_front();
    }
};

template <class T>
Script<void> keep(Script<Result<T>> script, std::optional<Result<T>>& result) {
    Result<T> value = co_await script;
    result.emplace(std::move(value));
}

class SdoClient : public ::testing::Test {
protected:
    SdoClient() {
        mailbox.subject = "slave 2 'y' (sv33-e)";
        mailbox.station = 0x1003;
        mailbox.log = &log;
        mailbox.out_start = out_start;
        mailbox.in_start = in_start;
        mailbox.out_size = mailbox.in_size = box_size;
    }
    template <class T>
    Result<T> run(Script<Result<T>> script) {
        std::optional<Result<T>> result;
        Runner runner{keep(std::move(script), result)};
        for (int i = 0; i < 10'000 && !runner.done(); ++i) {
            now += 1ms;
            exchange.receive(now);
            channel.collect(now);
            runner.step(now);
            channel.pack(now, 16);
        }
        return result ? std::move(*result) : Result<T>{Error{"test.hangs", "", "the script does not end", ""}};
    }
    Result<Bytes> upload(std::uint16_t index, std::uint8_t sub) { return run(sdo_upload(port, mailbox, index, sub)); }
    Result<void> download(std::uint16_t index, std::uint8_t sub, Bytes data) {
        return run(sdo_download(port, mailbox, index, sub, std::move(data)));
    }
    static MailboxSlave::Reply coe(std::initializer_list<int> values) { return {MailboxType::coe, bytes(values)}; }

    MailboxSlave slave;
    LoopbackTransport transport{slave};
    Exchange exchange{transport};
    AcyclicChannel channel{exchange};
    DatagramPort port{channel};
    EmergencyLog log;
    MailboxEndpoint mailbox;
    Instant now{};
};

// Request: CoE service 2, upload (40h). Response: CoE service 3, 4Bh = expedited, size given, 2 unused bytes: 1234h.
TEST_F(SdoClient, UploadsExpedited) {
    slave.script = {{coe({0x00, 0x30, 0x4B, 0x41, 0x60, 0x00, 0x34, 0x12, 0, 0})}};
    const auto value = upload(0x6041, 0);
    ASSERT_TRUE(value) << value.error().text();
    EXPECT_EQ(*value, bytes({0x34, 0x12}));
    ASSERT_THAT(slave.requests, SizeIs(1));
    EXPECT_THAT(slave.requests[0], SizeIs(box_size)) << "only a full mailbox switches";
    EXPECT_EQ(Bytes(slave.requests[0].begin(), slave.requests[0].begin() + 12),
              bytes({10, 0, 0, 0, 0, 0x13, 0x00, 0x20, 0x40, 0x41, 0x60, 0x00}))
        << "length 10, CoE, counter 1";
}

TEST_F(SdoClient, CountsItsMessagesFromOneToSeven) {
    for (int i = 0; i < 9; ++i) slave.script.push_back({coe({0x00, 0x30, 0x4F, 0x61, 0x60, 0x00, 8, 0, 0, 0})});
    std::vector<int> counters;
    for (int i = 0; i < 9; ++i) ASSERT_TRUE(upload(0x6061, 0));
    for (const auto& request : slave.requests) counters.push_back(std::to_integer<int>(request[5]) >> 4);
    EXPECT_THAT(counters, ElementsAre(1, 2, 3, 4, 5, 6, 7, 1, 2));
}

// 41h: normal, size given (5). The five bytes follow in the same message.
TEST_F(SdoClient, UploadsNormal) {
    slave.script = {{coe({0x00, 0x30, 0x41, 0x08, 0x10, 0x00, 5, 0, 0, 0, 'S', 'V', '3', '3', 'E'})}};
    const auto value = upload(0x1008, 0);
    ASSERT_TRUE(value) << value.error().text();
    EXPECT_EQ(*value, bytes({'S', 'V', '3', '3', 'E'}));
}

// 9 bytes, none in the first answer; segments of 7 (toggle 0) and 2 (toggle 1, 5 unused, last): 00h, 1Bh.
TEST_F(SdoClient, UploadsInSegmentsAndTogglesTheRequests) {
    slave.script = {{coe({0x00, 0x30, 0x41, 0x08, 0x10, 0x00, 9, 0, 0, 0})},
                    {coe({0x00, 0x30, 0x00, 'a', 'b', 'c', 'd', 'e', 'f', 'g'})},
                    {coe({0x00, 0x30, 0x1B, 'h', 'i', 0, 0, 0, 0, 0})}};
    const auto value = upload(0x1008, 0);
    ASSERT_TRUE(value) << value.error().text();
    EXPECT_EQ(*value, bytes({'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h', 'i'}));
    EXPECT_EQ(slave.requests[1][8], std::byte{0x60});
    EXPECT_EQ(slave.requests[2][8], std::byte{0x70});
}

TEST_F(SdoClient, AWrongToggleBitIsAnErrorNotData) {
    slave.script = {{coe({0x00, 0x30, 0x41, 0x08, 0x10, 0x00, 9, 0, 0, 0})}, {coe({0x00, 0x30, 0x10, 'a', 'b', 'c', 'd', 'e', 'f', 'g'})}};
    EXPECT_EQ(upload(0x1008, 0).error().code, "sdo.protocol");
}

TEST_F(SdoClient, SegmentsLongerThanAnnouncedAreAnError) {
    slave.script = {{coe({0x00, 0x30, 0x41, 0x08, 0x10, 0x00, 5, 0, 0, 0})}, {coe({0x00, 0x30, 0x01, 'a', 'b', 'c', 'd', 'e', 'f', 'g'})}};
    EXPECT_EQ(upload(0x1008, 0).error().code, "sdo.protocol");
}

// Emergency: CoE service 1, code 3220h (SV33-E: undervoltage), register 04h. It stands between request and answer.
TEST_F(SdoClient, KeepsEmergenciesThatComeBeforeTheAnswer) {
    slave.script = {{coe({0x00, 0x10, 0x20, 0x32, 0x04, 1, 2, 3, 4, 5}), coe({0x00, 0x30, 0x4B, 0x41, 0x60, 0x00, 0x34, 0x12, 0, 0})}};
    const auto value = upload(0x6041, 0);
    ASSERT_TRUE(value) << value.error().text();
    ASSERT_THAT(log.entries(), SizeIs(1));
    EXPECT_EQ(log.entries()[0].emergency.code, 0x3220);
}

TEST_F(SdoClient, SkipsAnswersToEarlierRequestsAndForeignProtocols) {
    slave.script = {{{MailboxType::eoe, bytes({1, 2, 3, 4})},
                     coe({0x00, 0x30, 0x4F, 0x61, 0x60, 0x00, 8, 0, 0, 0}),  // 6061h: asked long ago
                     coe({0x00, 0x30, 0x4B, 0x41, 0x60, 0x00, 0x34, 0x12, 0, 0})}};
    const auto value = upload(0x6041, 0);
    ASSERT_TRUE(value);
    EXPECT_EQ(*value, bytes({0x34, 0x12}));
}

// Abort: service 2, 80h, 06010002h.
TEST_F(SdoClient, AbortsNameSlaveObjectCodeAndRemedy) {
    slave.script = {{coe({0x00, 0x20, 0x80, 0x41, 0x60, 0x00, 0x02, 0x00, 0x01, 0x06})}};
    const auto refused = download(0x6041, 0, bytes({1, 0}));
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().text(), HasSubstr("slave 2 'y' (sv33-e): writing 6041h:00 was refused: abort 06010002h"));
    EXPECT_EQ(abort_code(refused.error()), sdo_abort::read_only);
    EXPECT_FALSE(refused.error().remedy.empty());
}

// Mailbox error 7, "no more memory", passes; the request is written again.
TEST_F(SdoClient, AsksAgainWhenTheSlaveHasNoMemoryNow) {
    slave.script = {{{MailboxType::error, bytes({1, 0, 7, 0})}}, {coe({0x00, 0x30, 0x60, 0x85, 0x60, 0x00, 0, 0, 0, 0})}};
    const auto written = download(0x6085, 0, bytes({1, 0, 0, 0}));
    EXPECT_TRUE(written) << written.error().text();
    EXPECT_THAT(slave.requests, SizeIs(2));
}

TEST_F(SdoClient, OtherMailboxErrorsEndTheRequest) {
    slave.script = {{{MailboxType::error, bytes({1, 0, 2, 0})}}};
    const auto refused = download(0x6085, 0, bytes({1, 0, 0, 0}));
    EXPECT_EQ(refused.error().code, "sdo.mailbox");
    EXPECT_THAT(refused.error().what, HasSubstr("mailbox error 2"));
}

TEST_F(SdoClient, GivesUpAfterTwoSecondsOfSilence) {
    const Instant before = now;
    EXPECT_EQ(upload(0x6041, 0).error().code, "sdo.timeout");
    EXPECT_NEAR(to_seconds(now - before), 2.0, 0.05);
}

TEST_F(SdoClient, GivesUpWhenTheMailboxStaysFull) {
    slave.full = true;
    const auto refused = upload(0x6041, 0);
    EXPECT_EQ(refused.error().code, "sdo.mailbox");
    EXPECT_THAT(refused.error().what, HasSubstr("stays full"));
}

// A mailbox of 128 bytes carries 128 - 6 - 10 = 112 bytes with the first request, 119 with each segment.
TEST_F(SdoClient, DownloadsLongValuesInSegments) {
    slave.script = {{coe({0x00, 0x30, 0x60, 0x00, 0x20, 0x01, 0, 0, 0, 0})},
                    {coe({0x00, 0x30, 0x20, 0, 0, 0, 0, 0, 0, 0})},
                    {coe({0x00, 0x30, 0x30, 0, 0, 0, 0, 0, 0, 0})}};
    const auto written = download(0x2000, 1, Bytes(250, std::byte{'x'}));
    ASSERT_TRUE(written) << written.error().text();
    ASSERT_THAT(slave.requests, SizeIs(3));
    EXPECT_EQ(slave.requests[0][12], std::byte{250});
    EXPECT_EQ(slave.requests[1][8], std::byte{0x00}) << "119 more, toggle 0, not the last";
    EXPECT_EQ(slave.requests[2][8], std::byte{0x11}) << "19 more, toggle 1, the last";
}

TEST_F(SdoClient, SlavesWithoutMailboxSaySo) {
    mailbox.in_size = 0;
    EXPECT_EQ(upload(0x6041, 0).error().code, "sdo.no_mailbox");
}

}  // namespace
}  // namespace taktwerk::ecat
