// Transfers of whole objects, byte for byte. Source: ETG.1000.6 5.6.2: complete access bit 10h of the command byte, sub-index 0
// padded to 16 bits. Requests: upload 50h; download expedited 33h with size, normal 31h.
#include <gmock/gmock.h>

#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::sim {
namespace {

DeviceDescription with_records() {
    auto d = small_drive();
    d.mailbox->complete_access = true;
    const auto add = [&](std::uint8_t sub, DataType type, Access access, std::int64_t value) {
        ObjectEntry e;
        e.index = 0x3000, e.sub = sub, e.type = type, e.access = access, e.value = value;
        d.objects.push_back(e);
    };
    // One byte, two bits, a word: the bits share a byte, the word starts at the next.
    add(1, DataType::U8, Access::rw, 0x11);
    add(2, DataType::BOOL, Access::rw, 1);
    add(3, DataType::BOOL, Access::rw, 0);
    add(4, DataType::I16, Access::rw, -2);
    add(5, DataType::U8, Access::ro, 0x55);
    add(6, DataType::U8, Access::wo, 0x66);
    return d;
}

struct CompleteAccess : testing::Test {
    CompleteAccess() : slave(bus.add_drive({}, with_records())) { bus.to_preop(0); }
    Bytes upload(std::uint16_t index, std::uint8_t sub) {
        return bus.coe(0, bytes({0x00, 0x20, 0x50, index & 0xFF, index >> 8, sub, 0, 0, 0, 0}));
    }
    /// Normal download of any length up to the mailbox.
    std::uint32_t download(std::uint16_t index, std::uint8_t sub, Bytes data) {
        Bytes request = bytes({0x00, 0x20, 0x31, index & 0xFF, index >> 8, sub, static_cast<int>(data.size()), 0, 0, 0});
        request.insert(request.end(), data.begin(), data.end());
        const auto answer = bus.coe(0, request);
        if (answer.size() < 10) return 0xFFFF'FFFF;
        if (answer[2] == std::byte{0x80}) return load_le<std::uint32_t>(answer, 6);
        EXPECT_EQ(answer[2], std::byte{0x70}) << "download response with the complete access bit";
        return 0;
    }
    static std::uint32_t abort_of(const Bytes& answer) {
        return answer.size() >= 10 && answer[2] == std::byte{0x80} ? load_le<std::uint32_t>(answer, 6) : 0;
    }
    std::int64_t value(std::uint8_t sub) { return slave.dictionary().value(0x3000, sub); }

    BusProbe bus;
    SimSlave& slave;
};

// 06h 00h | 11h | bits 01b | FEh FFh | 55h | write-only: 00h. Eight bytes, response 51h: complete access, size given.
TEST_F(CompleteAccess, UploadFromSubindex0StartsWithTheCountIn16Bits) {
    EXPECT_EQ(upload(0x3000, 0), bytes({0x00, 0x30, 0x51, 0x00, 0x30, 0x00, 8, 0, 0, 0, 0x06, 0x00, 0x11, 0x01, 0xFE, 0xFF, 0x55, 0x00}));
}

TEST_F(CompleteAccess, UploadFromSubindex1HasNoCount) {
    EXPECT_EQ(upload(0x3000, 1), bytes({0x00, 0x30, 0x51, 0x00, 0x30, 0x01, 6, 0, 0, 0, 0x11, 0x01, 0xFE, 0xFF, 0x55, 0x00}));
}

// A list has as many entries as its count says: one of four mapped objects are there (1600h maps two).
TEST_F(CompleteAccess, AListIsAsLongAsItsCount) {
    EXPECT_EQ(upload(0x1600, 0), bytes({0x00, 0x30, 0x51, 0x00, 0x16, 0x00, 10, 0, 0, 0, 2, 0, 0x10, 0, 0x40, 0x60, 0x20, 0, 0x7A, 0x60}));
    EXPECT_EQ(upload(0x1C12, 0), bytes({0x00, 0x30, 0x53, 0x12, 0x1C, 0x00, 0x01, 0x00, 0x00, 0x16})) << "four bytes are expedited";
}

TEST_F(CompleteAccess, DownloadWritesAllThatCanBeWritten) {
    EXPECT_EQ(download(0x3000, 1, bytes({0x22, 0x02, 0x34, 0x12, 0x99, 0x77})), 0u);

    EXPECT_EQ(value(1), 0x22);
    EXPECT_EQ(value(2), 0);
    EXPECT_EQ(value(3), 1);
    EXPECT_EQ(value(4), 0x1234);
    EXPECT_EQ(value(5), 0x55) << "read-only keeps its value";
    EXPECT_EQ(value(6), 0x77);
    EXPECT_EQ(bus.recorders[0]->writes.size(), 5u) << "the application is told of each";
}

TEST_F(CompleteAccess, OneBadValueAndNothingIsWritten) {
    bus.recorders[0]->refused_object = 0x3000;
    bus.recorders[0]->refused_code = 0x06090030;

    EXPECT_EQ(download(0x3000, 1, bytes({0x22, 0x02, 0x34, 0x12, 0x99, 0x77})), 0x06090030u);

    EXPECT_EQ(value(1), 0x11);
    EXPECT_EQ(value(4), -2);
}

TEST_F(CompleteAccess, TheSizeMustBeThatOfTheObject) {
    EXPECT_EQ(download(0x3000, 1, bytes({0x22, 0x02, 0x34, 0x12, 0x99})), 0x06070013u);
    EXPECT_EQ(download(0x3000, 1, bytes({0x22, 0x02, 0x34, 0x12, 0x99, 0x77, 0})), 0x06070012u);
}

// The whole mapping in one transfer; the slave itself goes through 0, entries, count.
TEST_F(CompleteAccess, AMappingIsReplacedAtOnce) {
    EXPECT_EQ(download(0x1600, 0, bytes({1, 0, 0x08, 0, 0x60, 0x60})), 0u);

    EXPECT_EQ(slave.dictionary().value(0x1600, 0), 1);
    EXPECT_EQ(slave.dictionary().value(0x1600, 1), 0x60600008);
}

TEST_F(CompleteAccess, AMappingThatIsNotPossibleLeavesTheOldOne) {
    EXPECT_EQ(download(0x1600, 0, bytes({2, 0, 0x08, 0, 0x60, 0x60, 0x10, 0, 0x41, 0x60})), 0x06040041u) << "6041h is an input";

    EXPECT_EQ(slave.dictionary().value(0x1600, 0), 2);
    EXPECT_EQ(slave.dictionary().value(0x1600, 1), 0x60400010);
    EXPECT_EQ(slave.dictionary().value(0x1600, 2), 0x607A0020);
}

TEST_F(CompleteAccess, EntriesOfAMappingAloneNeedItsCountToBeZero) {
    EXPECT_EQ(download(0x1600, 1, bytes({0x08, 0, 0x60, 0x60, 0x20, 0, 0x7A, 0x60})), 0x06010003u);
}

TEST_F(CompleteAccess, AssignmentsBelongToPreop) {
    bus.process_managers(0);
    bus.request(0, 4);

    EXPECT_EQ(download(0x1C12, 0, bytes({1, 0, 0x01, 0x17, 0, 0})), 0x06070012u) << "two bytes too many";
    EXPECT_EQ(abort_of(bus.coe(0, bytes({0x00, 0x20, 0x33, 0x12, 0x1C, 0x00, 1, 0, 0x01, 0x17}))), 0x08000022u);
}

TEST_F(CompleteAccess, IsRefusedForVariablesOtherSubindicesAndReadOnlyObjects) {
    EXPECT_EQ(abort_of(upload(0x6040, 0)), 0x06010004u);
    EXPECT_EQ(abort_of(upload(0x3000, 2)), 0x06010000u);
    EXPECT_EQ(abort_of(upload(0x5000, 0)), 0x06020000u);
    EXPECT_EQ(abort_of(upload(0x2000, 0)), 0x06010001u) << "its only entry is write-only";
    EXPECT_EQ(download(0x1018, 1, Bytes(16)), 0x06010002u);
}

// 300 bytes: 112 with the first message of a 128-byte mailbox, then 119, then 69.
TEST(CompleteAccessSegments, ALongObjectComesAndGoesInSegments) {
    auto d = small_drive();
    d.mailbox->complete_access = true;
    for (std::uint8_t sub = 1; sub <= 75; ++sub) {
        ObjectEntry e;
        e.index = 0x3000, e.sub = sub, e.type = DataType::U32, e.value = sub;
        d.objects.push_back(e);
    }
    BusProbe bus;
    auto& slave = bus.add_drive({}, d);
    bus.to_preop(0);

    const auto first = bus.coe(0, bytes({0x00, 0x20, 0x50, 0x00, 0x30, 0x01, 0, 0, 0, 0}));
    const auto second = bus.coe(0, bytes({0x00, 0x20, 0x60, 0, 0, 0, 0, 0, 0, 0}));
    const auto third = bus.coe(0, bytes({0x00, 0x20, 0x70, 0, 0, 0, 0, 0, 0, 0}));
    Bytes all(first.begin() + 10, first.end());
    all.insert(all.end(), second.begin() + 3, second.end());
    all.insert(all.end(), third.begin() + 3, third.end());
    ASSERT_EQ(all.size(), 300u);
    EXPECT_EQ(load_le<std::uint32_t>(all, 74 * 4), 75u);

    Bytes head = bytes({0x00, 0x20, 0x31, 0x00, 0x30, 0x01, 0x2C, 0x01, 0, 0});
    head.insert(head.end(), 112, std::byte{0xAA});
    Bytes more = bytes({0x00, 0x20, 0x00});
    more.insert(more.end(), 119, std::byte{0xAA});
    Bytes rest = bytes({0x00, 0x20, 0x11});
    rest.insert(rest.end(), 69, std::byte{0xAA});
    EXPECT_EQ(bus.coe(0, head)[2], std::byte{0x70});
    EXPECT_EQ(bus.coe(0, more)[2], std::byte{0x20});
    EXPECT_EQ(bus.coe(0, rest)[2], std::byte{0x30});
    EXPECT_EQ(slave.dictionary().value(0x3000, 1), 0xAAAAAAAA);
    EXPECT_EQ(slave.dictionary().value(0x3000, 75), 0xAAAAAAAA);
}

}  // namespace
}  // namespace taktwerk::ecat::sim
