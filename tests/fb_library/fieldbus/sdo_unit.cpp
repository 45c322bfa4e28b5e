// EC_SdoRead and EC_SdoWrite against a device that answers when the test says so.

#include "fb_library/fieldbus/sdo.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace taktwerk::fb {
namespace {

/// One device, any number of requests; remembers what is held and what was written.
class FakeObjects final : public ObjectAccess {
public:
    ObjectTicket read(DeviceRef device, std::uint16_t, std::uint8_t) noexcept override { return ask(device); }
    ObjectTicket write(DeviceRef device, std::uint16_t, std::uint8_t, std::span<const std::byte> data) noexcept override {
        written.assign(data.begin(), data.end());
        return ask(device);
    }
    ObjectOutcome why(DeviceRef device, std::size_t) const noexcept override {
        return device.index != 0 ? ObjectOutcome::invalid_device : full ? ObjectOutcome::no_place : ObjectOutcome::pending;
    }
    ObjectAnswer answer(ObjectTicket ticket) const noexcept override {
        return ticket.generation == newest && held > 0 ? now : ObjectAnswer{};
    }
    void release(ObjectTicket ticket) noexcept override { held -= ticket.valid() ? 1 : 0; }

    void answers(std::vector<unsigned> bytes) {
        value.clear();
        for (const unsigned b : bytes) value.push_back(static_cast<std::byte>(b));
        now = {ObjectOutcome::done, 0, value};
    }

    ObjectAnswer now{ObjectOutcome::pending, 0, {}};
    std::vector<std::byte> value, written;
    std::uint32_t newest = 0;
    int held = 0;
    bool full = false;

private:
    ObjectTicket ask(DeviceRef device) noexcept {
        if (device.index != 0 || full) return {};
        ++held;
        return {0, ++newest};
    }
};

struct Sdo : testing::Test {
    FakeObjects objects;
    MotionContext ctx = [this] {
        MotionContext c;
        c.objects = &objects;
        return c;
    }();
    EC_SdoRead read = [] {
        EC_SdoRead b;
        b.Device = DeviceRef{0};
        b.Execute = true;
        return b;
    }();
};

TEST_F(Sdo, TheValueIsThereWhenDoneIsAndThePlaceIsGivenBack) {
    read(ctx);
    EXPECT_TRUE(read.Busy);
    objects.answers({0x34, 0x12});
    read(ctx);
    EXPECT_TRUE(read.Done);
    EXPECT_EQ(read.Value, 0x1234);
    EXPECT_EQ(read.Size, 2);
    EXPECT_EQ(objects.held, 0);
}

TEST_F(Sdo, ASignedObjectKeepsItsSignAndAnUnsignedOneIsPositive) {
    objects.answers({0xFE, 0xFF});
    read(ctx);
    EXPECT_EQ(read.Value, 0xFFFE);
    read.Execute = false;
    read(ctx);
    read.Execute = read.Signed = true;
    read(ctx);
    EXPECT_EQ(read.Value, -2);
}

TEST_F(Sdo, EightBytesAreTheLimit) {
    objects.answers({1, 2, 3, 4, 5, 6, 7, 8, 9});
    read(ctx);
    EXPECT_TRUE(read.Error);
    EXPECT_EQ(read.ErrorID, ErrorId::object_too_long);
    EXPECT_EQ(objects.held, 0);
}

TEST_F(Sdo, TheAbortCodeOfTheDeviceIsShown) {
    objects.now = {ObjectOutcome::refused, 0x06010002, {}};
    read(ctx);
    EXPECT_EQ(read.ErrorID, ErrorId::object_refused);
    EXPECT_EQ(read.AbortCode, 0x06010002u);
}

TEST_F(Sdo, ANewEdgeWhileBusyDropsTheFormerRequest) {
    read(ctx);
    read.Execute = false;
    read(ctx);
    EXPECT_TRUE(read.Busy) << "a falling Execute changes nothing";
    read.Execute = true;
    read(ctx);
    EXPECT_EQ(objects.held, 1);
    EXPECT_EQ(objects.newest, 2u);
}

TEST_F(Sdo, WhatIsMissingIsNamed) {
    EC_SdoRead elsewhere = read;
    elsewhere.Device = DeviceRef{7};
    elsewhere(ctx);
    EXPECT_EQ(elsewhere.ErrorID, ErrorId::invalid_device);

    EC_SdoRead crowded = read;
    objects.full = true;
    crowded(ctx);
    EXPECT_EQ(crowded.ErrorID, ErrorId::object_requests_full);

    ctx.objects = nullptr;  // a machine without a bus
    read(ctx);
    EXPECT_EQ(read.ErrorID, ErrorId::invalid_device);
}

TEST_F(Sdo, TheLowBytesAreWrittenLittleEndian) {
    EC_SdoWrite write;
    write.Device = DeviceRef{0};
    write.Value = -2;
    write.Size = 2;
    write.Execute = true;
    write(ctx);
    EXPECT_EQ(objects.written, (std::vector{std::byte{0xFE}, std::byte{0xFF}}));
    objects.answers({});
    write(ctx);
    EXPECT_TRUE(write.Done);
}

TEST_F(Sdo, ASizeThatNoObjectHasIsRefused) {
    EC_SdoWrite write;
    write.Device = DeviceRef{0};
    write.Execute = true;
    write.Size = 9;
    write(ctx);
    EXPECT_EQ(write.ErrorID, ErrorId::invalid_parameter);
}

}  // namespace
}  // namespace taktwerk::fb
