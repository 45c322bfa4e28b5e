// The mailbox of a simulated slave apart from SDOs: emergencies, SDO information byte for byte, repetitions, malformed messages.
// Source: ETG.1000.4 (mailbox), ETG.1000.6 5.6.3 and 5.6.4, SV33-E manual 6.2.8.
#include <gmock/gmock.h>

#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::sim {
namespace {

using testing::SizeIs;

class Alarming final : public DeviceModel {
public:
    void power_on(ObjectDictionary&, Instant) override {}
    void exchange(Instant) override {}
    void raise(std::uint16_t code) { send_emergency({code, 0x21, {std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4}, std::byte{5}}}); }
};

struct SlaveMailbox : testing::Test {
    SlaveMailbox() {
        auto description = small_drive();
        description.mailbox->sdo_info = true;
        auto owned = std::make_unique<Alarming>();
        model = owned.get();
        bus.add(description, std::move(owned));
        bus.to_preop(0);
    }
    /// What waits in the mailbox, without asking for it: header and payload.
    Bytes take() {
        const auto answer = bus.read(0, 0x1400, 0x80);
        if (answer.wkc == 0) return {};
        return Bytes(answer.data.begin(), answer.data.begin() + 6 + load_le<std::uint16_t>(answer.data));
    }
    /// The whole mailbox, as it stands.
    Bytes raw(Bytes message) {
        message.resize(0x80);
        bus.write(0, 0x1000, message);
        bus.wait(5ms);
        return take();
    }
    bool full() { return (bus.value<std::uint8_t>(0, 0x080D) & 0x08) != 0; }

    BusProbe bus;
    Alarming* model = nullptr;
};

// Length 10, CoE, the slave's counter 1; CoE service 1; code 7320h, register 21h, five bytes.
TEST_F(SlaveMailbox, AnEmergencyStandsInTheMailboxWithoutBeingAskedFor) {
    model->raise(0x7320);

    EXPECT_TRUE(full());
    EXPECT_EQ(take(), bytes({10, 0, 0, 0, 0, 0x13, 0x00, 0x10, 0x20, 0x73, 0x21, 1, 2, 3, 4, 5}));
    EXPECT_FALSE(full());
}

TEST_F(SlaveMailbox, EmergenciesComeInOrderAndBeforeAnAnswerThatWaits) {
    model->raise(0x1000);
    model->raise(0x2000);
    bus.coe(0, bytes({0x00, 0x20, 0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0}));  // takes the first out of the mailbox

    const auto second = take();
    const auto answer = take();

    EXPECT_EQ(second[9], std::byte{0x20});
    EXPECT_EQ(answer[8], std::byte{0x43});
    EXPECT_TRUE(take().empty());
}

TEST_F(SlaveMailbox, BeforePreopThereAreNoEmergencies) {
    bus.request(0, 1);
    model->raise(0x7320);
    bus.to_preop(0);

    EXPECT_FALSE(full());
    model->raise(0x7321);
    EXPECT_EQ(take()[8], std::byte{0x21}) << "the one raised in PREOP is the first";
    EXPECT_TRUE(take().empty());
}

// The master reads A; its frame is lost; B has already taken A's place. The repetition brings A, then B.
TEST_F(SlaveMailbox, ARepetitionBringsWhatWasReadLastAndThenWhatItDisplaced) {
    model->raise(0x1000);
    model->raise(0x2000);
    const auto lost = take();

    bus.write(0, 0x080E, bytes({0x03}));

    EXPECT_EQ(take(), lost);
    EXPECT_EQ(take()[9], std::byte{0x20});
    EXPECT_TRUE(take().empty());
}

// The frame was lost on its way out: the slave repeats what was read before; the counter shows it. Then comes what waits.
TEST_F(SlaveMailbox, ARepetitionOfWhatWasNeverReadComesAfterTheOneBefore) {
    model->raise(0x1000);
    const auto before = take();
    model->raise(0x2000);

    bus.write(0, 0x080E, bytes({0x03}));

    EXPECT_EQ(take(), before);
    EXPECT_EQ(take()[9], std::byte{0x20});
}

// Opcode 2, nothing left; list type 2: RxPDO-mappable objects.
TEST_F(SlaveMailbox, ListsObjectsOfAKind) {
    EXPECT_EQ(bus.coe(0, bytes({0x00, 0x80, 0x01, 0, 0, 0, 0x02, 0x00})),
              bytes({0x00, 0x80, 0x02, 0, 0, 0, 0x02, 0x00, 0x40, 0x60, 0x60, 0x60, 0x7A, 0x60}));
}

// List type 0: the five lengths. All 21; 3 and 2 mappable; none to be backed up or set at start-up.
TEST_F(SlaveMailbox, CountsObjectsOfEachKind) {
    EXPECT_EQ(bus.coe(0, bytes({0x00, 0x80, 0x01, 0, 0, 0, 0x00, 0x00})),
              bytes({0x00, 0x80, 0x02, 0, 0, 0, 0x00, 0x00, 21, 0, 3, 0, 2, 0, 0, 0, 0, 0}));
}

// 6098h:00 has a range: value info 60h asks for minimum (-2) and maximum (35).
TEST_F(SlaveMailbox, AnEntryHasItsRangeWhereItIsAskedFor) {
    EXPECT_EQ(bus.coe(0, bytes({0x00, 0x80, 0x05, 0, 0, 0, 0x98, 0x60, 0x00, 0x60})),
              bytes({0x00, 0x80, 0x06, 0, 0, 0, 0x98, 0x60, 0x00, 0x60, 0x02, 0x00, 0x08, 0x00, 0x3F, 0x00, 0xFE, 0x23}));
    EXPECT_EQ(bus.coe(0, bytes({0x00, 0x80, 0x05, 0, 0, 0, 0x98, 0x60, 0x00, 0x00})),
              bytes({0x00, 0x80, 0x06, 0, 0, 0, 0x98, 0x60, 0x00, 0x00, 0x02, 0x00, 0x08, 0x00, 0x3F, 0x00}));
}

// Opcode 7 with 06020000h.
TEST_F(SlaveMailbox, InformationAboutNothingIsAnError) {
    EXPECT_EQ(bus.coe(0, bytes({0x00, 0x80, 0x03, 0, 0, 0, 0x00, 0x50})), bytes({0x00, 0x80, 0x07, 0, 0, 0, 0x00, 0x00, 0x02, 0x06}));
}

// Mailbox error (type 0): command 1, detail.
TEST_F(SlaveMailbox, MalformedMessagesGetAMailboxError) {
    const auto detail = [&](Bytes mailbox) {
        const auto answer = raw(std::move(mailbox));
        return answer.size() == 10 && (answer[5] & std::byte{0x0F}) == std::byte{0} ? static_cast<int>(answer[8]) : -1;
    };
    EXPECT_EQ(detail(bytes({0x7B, 0, 0, 0, 0, 0x13, 0x00, 0x20})), 8) << "123 bytes do not fit behind the header";
    EXPECT_EQ(detail(bytes({10, 0, 0, 0, 0, 0x24, 0x00, 0x20})), 2) << "FoE";
    EXPECT_EQ(detail(bytes({4, 0, 0, 0, 0, 0x30, 1, 0, 0, 0})), 5) << "an error from the master";
    EXPECT_EQ(detail(bytes({1, 0, 0, 0, 0, 0x43, 0x00})), 6) << "no CoE header";
    EXPECT_EQ(detail(bytes({5, 0, 0, 0, 0, 0x53, 0x00, 0x20, 0x40, 0x00, 0x10})), 6) << "half an SDO";
    EXPECT_EQ(detail(bytes({10, 0, 0, 0, 0, 0x63, 0x00, 0x40})), 4) << "TxPDO by mailbox";
    EXPECT_EQ(detail(bytes({10, 0, 0, 0, 0, 0x73, 0x00, 0x30, 0x60})), 4) << "an SDO response";
    EXPECT_EQ(detail(bytes({8, 0, 0, 0, 0, 0x13, 0x00, 0x80, 0x02})), 4) << "an answer instead of a question";
}

// Counter 0 is not checked: the same message twice is two messages.
TEST_F(SlaveMailbox, CounterZeroIsNeverARepetition) {
    const auto request = bytes({10, 0, 0, 0, 0, 0x03, 0x00, 0x20, 0x40, 0x00, 0x10, 0x00});

    EXPECT_THAT(raw(request), SizeIs(16));
    EXPECT_THAT(raw(request), SizeIs(16));
}

// The slave does not check the order of counters, only whether one comes twice (SV33-E manual table 6-9).
TEST_F(SlaveMailbox, CountersMayJump) {
    EXPECT_THAT(raw(bytes({10, 0, 0, 0, 0, 0x53, 0x00, 0x20, 0x40, 0x00, 0x10, 0x00})), SizeIs(16));
    EXPECT_THAT(raw(bytes({10, 0, 0, 0, 0, 0x23, 0x00, 0x20, 0x40, 0x00, 0x10, 0x00})), SizeIs(16));
    EXPECT_TRUE(raw(bytes({10, 0, 0, 0, 0, 0x23, 0x00, 0x20, 0x40, 0x00, 0x10, 0x00})).empty());
}

}  // namespace
}  // namespace taktwerk::ecat::sim
