// Mailbox and SDO server of a simulated slave, byte for byte. Source: ETG.1000.4 (mailbox), ETG.1000.6 5.6.2 (SDO),
// SV33-E manual 6.2.8 and 6.2.9, abort codes of CiA 301.

#include <gmock/gmock.h>

#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::sim {
namespace {

struct Sdo : testing::Test {
    Sdo() : slave(bus.add_drive()) { bus.to_preop(0); }
    BusProbe bus;
    SimSlave& slave;
};

std::uint32_t abort_of(const Bytes& answer) {
    return answer.size() >= 10 && answer[2] == std::byte{0x80} ? load_le<std::uint32_t>(answer, 6) : 0;
}

TEST_F(Sdo, UploadOfFourBytesIsExpedited) {
    const auto answer = bus.upload(0, 0x1000, 0);

    EXPECT_EQ(answer, bytes({0x00, 0x30, 0x43, 0x00, 0x10, 0x00, 0x92, 0x01, 0x02, 0x00}));
    EXPECT_EQ(bus.header, bytes({10, 0, 0, 0, 0, 0x13}));  // length, address, channel, CoE with the slave's counter 1
}

TEST_F(Sdo, UploadOfOneAndTwoBytesSaysHowManyAreUnused) {
    EXPECT_EQ(bus.upload(0, 0x6041, 0), bytes({0x00, 0x30, 0x4B, 0x41, 0x60, 0x00, 0x50, 0x02, 0x00, 0x00}));
    EXPECT_EQ(bus.upload(0, 0x6060, 0), bytes({0x00, 0x30, 0x4F, 0x60, 0x60, 0x00, 0x00, 0x00, 0x00, 0x00}));
}

TEST_F(Sdo, UploadOfMoreThanFourBytesIsNormal) {
    EXPECT_EQ(bus.upload(0, 0x1008, 0),
              bytes({0x00, 0x30, 0x41, 0x08, 0x10, 0x00, 11, 0, 0, 0, 'S', 'M', 'A', 'L', 'L', '-', 'D', 'R', 'I', 'V', 'E'}));
}

TEST_F(Sdo, ALongStringComesInSegments) {
    // Mailbox 128: payload 122, first part 112, each segment up to 119 bytes. 250 = 112 + 119 + 19.
    std::string text(250, 'x');
    text[0] = 'a', text[112] = 'b', text[231] = 'c';
    slave.dictionary().find(0x2001, 0)->set_text(text);

    const auto first = bus.upload(0, 0x2001, 0);
    const auto second = bus.coe(0, bytes({0x00, 0x20, 0x60, 0, 0, 0, 0, 0, 0, 0}));
    const auto third = bus.coe(0, bytes({0x00, 0x20, 0x70, 0, 0, 0, 0, 0, 0, 0}));

    ASSERT_EQ(first.size(), 122u);
    EXPECT_EQ(first[2], std::byte{0x41});
    EXPECT_EQ(load_le<std::uint32_t>(first, 6), 250u);
    EXPECT_EQ(first[10], std::byte{'a'});
    ASSERT_EQ(second.size(), 122u);
    EXPECT_EQ(second[2], std::byte{0x00});  // toggle 0, more follows
    EXPECT_EQ(second[3], std::byte{'b'});
    ASSERT_EQ(third.size(), 3u + 19u);
    EXPECT_EQ(third[2], std::byte{0x11});  // toggle 1, last
    EXPECT_EQ(third[3], std::byte{'c'});
}

TEST_F(Sdo, ASegmentWithTheWrongToggleAborts) {
    slave.dictionary().find(0x2001, 0)->set_text(std::string(250, 'x'));
    bus.upload(0, 0x2001, 0);

    EXPECT_EQ(abort_of(bus.coe(0, bytes({0x00, 0x20, 0x70, 0, 0, 0, 0, 0, 0, 0}))), 0x05030000u);
}

TEST_F(Sdo, ExpeditedDownloadStoresAndTellsTheModel) {
    const auto answer = bus.coe(0, bytes({0x00, 0x20, 0x23, 0x81, 0x60, 0x00, 0x40, 0x42, 0x0F, 0x00}));

    EXPECT_EQ(answer, bytes({0x00, 0x30, 0x60, 0x81, 0x60, 0x00, 0, 0, 0, 0}));
    EXPECT_EQ(slave.dictionary().value(0x6081, 0), 1'000'000);
    EXPECT_THAT(bus.recorders[0]->writes, testing::ElementsAre(0x608100u));
}

TEST_F(Sdo, ExpeditedDownloadWithoutASizeTakesTheObjectsOwn) {
    bus.coe(0, bytes({0x00, 0x20, 0x22, 0x60, 0x60, 0x00, 0x08, 0, 0, 0}));

    EXPECT_EQ(slave.dictionary().value(0x6060, 0), 8);
}

TEST_F(Sdo, NormalAndSegmentedDownload) {
    const auto normal = bus.coe(0, bytes({0x00, 0x20, 0x21, 0xF0, 0x60, 0x00, 8, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0x80}));
    EXPECT_EQ(normal[2], std::byte{0x60});
    EXPECT_EQ(slave.dictionary().value(0x60F0, 0), static_cast<std::int64_t>(0x8000'0000'0000'0001ull));

    // Ten bytes announced, three in the first message, seven in the segment.
    bus.coe(0, bytes({0x00, 0x20, 0x21, 0x01, 0x20, 0x00, 10, 0, 0, 0, 'a', 'b', 'c'}));
    const auto segment = bus.coe(0, bytes({0x00, 0x20, 0x01, 'd', 'e', 'f', 'g', 'h', 'i', 'j'}));
    EXPECT_EQ(segment[2], std::byte{0x20});
    EXPECT_EQ(slave.dictionary().find(0x2001, 0)->text(), "abcdefghij");
}

TEST_F(Sdo, AbortsSayWhy) {
    EXPECT_EQ(abort_of(bus.upload(0, 0x5000, 0)), 0x06020000u);                                             // no such object
    EXPECT_EQ(abort_of(bus.upload(0, 0x1018, 9)), 0x06090011u);                                             // no such subindex
    EXPECT_EQ(abort_of(bus.upload(0, 0x2000, 1)), 0x06010001u);                                             // write only
    EXPECT_EQ(bus.download(0, 0x6041, 0, 2, 0), 0x06010002u);                                               // read only
    EXPECT_EQ(bus.download(0, 0x6060, 0, 2, 8), 0x06070012u);                                               // too long
    EXPECT_EQ(bus.download(0, 0x6081, 0, 2, 8), 0x06070013u);                                               // too short
    EXPECT_EQ(bus.download(0, 0x6098, 0, 1, 36), 0x06090031u);                                              // too great
    EXPECT_EQ(bus.download(0, 0x6098, 0, 1, 0xFD), 0x06090032u);                                            // -3: too small
    EXPECT_EQ(bus.download(0, 0x6098, 0, 1, 0xFE), 0u);                                                     // -2
    EXPECT_EQ(abort_of(bus.coe(0, bytes({0x00, 0x20, 0x50, 0x18, 0x10, 0x00, 0, 0, 0, 0}))), 0x06010004u);  // complete access
    EXPECT_EQ(abort_of(bus.coe(0, bytes({0x00, 0x20, 0xE0, 0x18, 0x10, 0x00, 0, 0, 0, 0}))), 0x05040001u);  // no such command
}

TEST_F(Sdo, TheModelMayRefuseAWrite) {
    bus.recorders[0]->refused_object = 0x6081;
    bus.recorders[0]->refused_code = 0x08000021;

    EXPECT_EQ(bus.download(0, 0x6081, 0, 4, 5), 0x08000021u);
    EXPECT_EQ(slave.dictionary().value(0x6081, 0), 0);
}

TEST_F(Sdo, DerivedObjectsFollowFromTheDescription) {
    EXPECT_EQ(load_le<std::uint32_t>(bus.upload(0, 0x1018, 1), 6), 0x000007FBu);
    EXPECT_EQ(load_le<std::uint32_t>(bus.upload(0, 0x1018, 4), 6), 77u);
    EXPECT_EQ(load_le<std::uint32_t>(bus.upload(0, 0x1600, 2), 6), 0x607A0020u);
    EXPECT_EQ(load_le<std::uint32_t>(bus.upload(0, 0x1C12, 1), 6), 0x1600u);
    for (std::uint8_t n = 1; n <= 4; ++n) EXPECT_EQ(load_le<std::uint32_t>(bus.upload(0, 0x1C00, n), 6), n);
}

TEST_F(Sdo, AMappingIsWrittenOnlyWhileItsCountIsZero) {
    EXPECT_EQ(bus.download(0, 0x1600, 1, 4, 0x60600008), 0x06010003u);

    EXPECT_EQ(bus.download(0, 0x1600, 0, 1, 0), 0u);
    EXPECT_EQ(bus.download(0, 0x1600, 1, 4, 0x60600008), 0u);
    EXPECT_EQ(bus.download(0, 0x1600, 0, 1, 1), 0u);
    EXPECT_EQ(slave.dictionary().value(0x1600, 1), 0x60600008);
}

TEST_F(Sdo, AMappingTakesOnlyWhatIsMappableInItsDirectionAndLength) {
    bus.download(0, 0x1600, 0, 1, 0);

    EXPECT_EQ(bus.download(0, 0x1600, 1, 4, 0x60410010), 0x06040041u);  // an input
    EXPECT_EQ(bus.download(0, 0x1600, 1, 4, 0x60810020), 0x06040041u);  // not mappable
    EXPECT_EQ(bus.download(0, 0x1600, 1, 4, 0x60400020), 0x06040041u);  // 6040h has 16 bits
    EXPECT_EQ(bus.download(0, 0x1600, 1, 4, 0x00000008), 0u);           // a gap
    EXPECT_EQ(bus.download(0, 0x1600, 5, 4, 0x60400010), 0x06090011u);  // four entries are all there are
    EXPECT_EQ(bus.download(0, 0x1600, 0, 1, 5), 0x06090031u);
}

TEST_F(Sdo, AMappingLongerThanTheSlaveAllowsIsRefusedAtItsCount) {
    bus.download(0, 0x1600, 0, 1, 0);
    for (std::uint8_t n = 1; n <= 4; ++n) EXPECT_EQ(bus.download(0, 0x1600, n, 4, 0x607A0020), 0u);

    EXPECT_EQ(bus.download(0, 0x1600, 0, 1, 4), 0x06040042u);  // 16 bytes, 12 allowed
    EXPECT_EQ(bus.download(0, 0x1600, 0, 1, 3), 0u);
}

TEST_F(Sdo, AFixedMappingIsReadOnly) { EXPECT_EQ(bus.download(0, 0x1701, 0, 1, 0), 0x06010002u); }

TEST_F(Sdo, AnAssignmentFollowsTheSameOrderAndNamesOnlyExistingPdos) {
    EXPECT_EQ(bus.download(0, 0x1C12, 1, 2, 0x1701), 0x06010003u);
    EXPECT_EQ(bus.download(0, 0x1C12, 0, 1, 0), 0u);
    EXPECT_EQ(bus.download(0, 0x1C12, 1, 2, 0x1702), 0x06090030u);
    EXPECT_EQ(bus.download(0, 0x1C12, 1, 2, 0x1A00), 0x06090030u);
    EXPECT_EQ(bus.download(0, 0x1C12, 1, 2, 0x1701), 0u);
    EXPECT_EQ(bus.download(0, 0x1C12, 0, 1, 2), 0x06090031u);
    EXPECT_EQ(bus.download(0, 0x1C12, 0, 1, 1), 0u);
}

TEST_F(Sdo, MappingAndAssignmentBelongToPreop) {
    bus.process_managers(0);
    bus.request(0, 4);

    EXPECT_EQ(bus.download(0, 0x1600, 0, 1, 0), 0x08000022u);
    EXPECT_EQ(bus.download(0, 0x1C12, 0, 1, 0), 0x08000022u);
    EXPECT_EQ(bus.download(0, 0x6081, 0, 4, 3), 0u);
}

TEST_F(Sdo, TheAnswerTakesTheResponseDelay) {
    bus.coe(0, bytes({0x00, 0x20, 0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0}), 3, 199us);
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x080D), 0x00);
    bus.wait(1us);
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x080D), 0x09);  // full, written
}

TEST(Mailbox, QueuesWhatItCanAndThenStaysFull) {
    BusProbe bus;
    auto description = small_drive();
    description.mailbox->max_pending = 2;
    bus.add_drive({.response_delay = 10ms}, description);
    bus.to_preop(0);
    const auto put = [&](std::uint8_t counter) {
        Bytes m(0x80);
        const auto request = bytes({10, 0, 0, 0, 0, 0x03 | (counter << 4), 0x00, 0x20, 0x40, 0x00, 0x10, 0x00});
        std::copy(request.begin(), request.end(), m.begin());
        return bus.write(0, 0x1000, m).wkc;
    };

    EXPECT_EQ(put(1), 1);
    EXPECT_EQ(put(2), 1);
    EXPECT_EQ(put(3), 1) << "this one stays in the mailbox itself";
    EXPECT_EQ(put(4), 0);

    bus.wait(11ms);  // the first is answered; its place takes the waiting message
    EXPECT_EQ(bus.read(0, 0x1400, 0x80).wkc, 1);
    EXPECT_EQ(put(4), 1);
}

TEST(Mailbox, ARepeatedCounterIsNotServedTwice) {
    BusProbe bus;
    auto& slave = bus.add_drive();
    bus.to_preop(0);
    bus.counter = 2;
    bus.download(0, 0x6081, 0, 4, 1);

    bus.counter = 2;  // the same request number again
    const auto answer = bus.coe(0, bytes({0x00, 0x20, 0x23, 0x81, 0x60, 0x00, 2, 0, 0, 0}));

    EXPECT_TRUE(answer.empty());
    EXPECT_EQ(slave.dictionary().value(0x6081, 0), 1);
}

TEST(Mailbox, ALostAnswerComesAgainOnRepeatRequest) {
    BusProbe bus;
    bus.add_drive();
    bus.to_preop(0);
    const auto first = bus.upload(0, 0x1000, 0);
    const auto first_header = bus.header;

    bus.write(0, 0x080E, bytes({0x03}));  // enable and repeat request

    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x080F) & 0x02, 0x02) << "acknowledged";
    const auto again = bus.read(0, 0x1400, 0x80);
    ASSERT_EQ(again.wkc, 1);
    EXPECT_EQ(Bytes(again.data.begin(), again.data.begin() + 6), first_header);
    EXPECT_EQ(Bytes(again.data.begin() + 6, again.data.begin() + 16), first);
}

TEST(Mailbox, ErrorRepliesNameTheProblem) {
    BusProbe bus;
    bus.add_drive();
    bus.to_preop(0);

    EXPECT_EQ(bus.coe(0, bytes({1, 2, 3, 4}), 2), bytes({0x01, 0x00, 0x02, 0x00}));  // EoE: unsupported protocol
    EXPECT_EQ(static_cast<int>(bus.header[5]) & 0x0F, 0);
    EXPECT_EQ(bus.coe(0, bytes({0x00, 0x80, 1, 0, 0, 0, 1, 0})), bytes({0x01, 0x00, 0x04, 0x00}));  // SDO info: not supported
    EXPECT_EQ(bus.coe(0, bytes({0x00})), bytes({0x01, 0x00, 0x06, 0x00}));                          // too short
}

TEST(Mailbox, AStuckMailboxAnswersAfterItIsReleased) {
    BusProbe bus;
    auto& slave = bus.add_drive();
    bus.to_preop(0);
    slave.stick_mailbox(true);
    EXPECT_TRUE(bus.upload(0, 0x1000, 0).empty());

    slave.stick_mailbox(false);
    bus.wait(1ms);

    EXPECT_EQ(bus.read(0, 0x1400, 0x80).wkc, 1);
}

}  // namespace
}  // namespace taktwerk::ecat::sim
