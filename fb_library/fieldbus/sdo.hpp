#pragma once
// EC_SdoRead and EC_SdoWrite: one object of a slave, read or written while the machine runs. No PLCopen part names such blocks; the
// pins follow the Execute pattern of PLCopen Part 1, 2.4.1, so that they read like the MC_ blocks beside them. Real-time safe.
// Objects of up to 8 bytes; longer ones by taktwerk::ObjectFuture (programs/api/object_future.hpp).

#include <array>
#include <cstdint>
#include <string_view>

#include "core/object_access.hpp"
#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

using taktwerk::DeviceRef;

template <>
struct PinTypeOf<DeviceRef> {
    static constexpr PinType value{PinKind::DEVICE_REF, "DEVICE_REF"};
};

namespace detail {

constexpr ErrorId object_error(ObjectOutcome outcome) noexcept {
    switch (outcome) {
        case ObjectOutcome::refused: return ErrorId::object_refused;
        case ObjectOutcome::no_place: return ErrorId::object_requests_full;
        case ObjectOutcome::invalid_device: return ErrorId::invalid_device;
        case ObjectOutcome::too_long: return ErrorId::object_too_long;
        default: return ErrorId::object_no_answer;
    }
}

/// What both blocks do between edge and outcome.
struct ObjectRequest {
    ObjectTicket ticket{};

    /// Takes the answer when it is there; `done(data)` gets it.
    template <class Block, class Done>
    void follow(const MotionContext& ctx, Block& block, ExecuteCore& core, Done done) noexcept {
        const ObjectAnswer answer = ctx.objects != nullptr ? ctx.objects->answer(ticket) : ObjectAnswer{};
        if (answer.outcome == ObjectOutcome::pending) return;
        if (answer.outcome == ObjectOutcome::done) {
            done(answer.data);
        } else {
            block.AbortCode = answer.abort_code;
            core.refuse(object_error(answer.outcome));
        }
        drop(ctx);
    }
    void drop(const MotionContext& ctx) noexcept {
        if (ctx.objects != nullptr) ctx.objects->release(ticket);
        ticket = {};
    }
    void accept(const MotionContext& ctx, ExecuteCore& core, DeviceRef device, std::size_t size) noexcept {
        if (ticket.valid()) core.start(AxisRef{});
        else core.refuse(object_error(ctx.objects->why(device, size)));
    }
};

}  // namespace detail

/// The value arrives some scans after the edge; Value keeps it until the next one has arrived.
struct EC_SdoRead : ExecuteBlock<EC_SdoRead> {
    DeviceRef Device{};
    bool Execute = false;
    std::uint16_t Index = 0;
    std::uint8_t SubIndex = 0;
    bool Signed = false;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    std::uint32_t AbortCode = 0;
    std::int64_t Value = 0;
    std::uint8_t Size = 0;

    detail::ObjectRequest request{};  ///< not a pin

    static constexpr std::string_view summary = "Reads an object of a slave (SDO upload) without disturbing the cycle.";
    template <class Self>
    static consteval auto pins() {
        return std::array{
            in_out<&Self::Device>("", "slave that has the object"),
            in<&Self::Execute>("", "a rising edge starts"),
            in<&Self::Index>("", "of the object, e.g. 6041h"),
            in<&Self::SubIndex>("", "of the object"),
            in<&Self::Signed>("", "the object is signed: Value is extended with its sign"),
            out<&Self::Done>("", "Value is the object's"),
            out<&Self::Busy>("", "not finished"),
            out<&Self::Error>("", "refused, or no answer"),
            out<&Self::ErrorID>("", "why"),
            out<&Self::AbortCode>("", "the slave's SDO abort code; 0 = it did not refuse"),
            out<&Self::Value>("", "the object's value; objects above 8 bytes give Error"),
            out<&Self::Size>("", "bytes of the object"),
        };
    }

private:
    friend ExecuteBlock<EC_SdoRead>;
    void start(const MotionContext& ctx) noexcept {
        if (ctx.objects == nullptr) return core_.refuse(ErrorId::invalid_device);
        request.drop(ctx);
        AbortCode = 0;
        request.ticket = ctx.objects->read(Device, Index, SubIndex);
        request.accept(ctx, core_, Device, 0);
    }
    void follow(const MotionContext& ctx) noexcept {
        request.follow(ctx, *this, core_, [this](std::span<const std::byte> data) {
            if (data.size() > sizeof(Value)) return core_.refuse(ErrorId::object_too_long);
            std::uint64_t bits = 0;
            for (std::size_t i = data.size(); i-- > 0;) bits = (bits << 8) | static_cast<std::uint64_t>(data[i]);
            const bool negative = !data.empty() && (data.back() & std::byte{0x80}) != std::byte{0};
            if (Signed && negative && data.size() < sizeof(Value)) bits |= ~std::uint64_t{0} << (8 * data.size());
            Value = static_cast<std::int64_t>(bits);
            Size = static_cast<std::uint8_t>(data.size());
            core_.finish();
        });
    }
};

/// Done when the slave has confirmed the value. A slave that keeps the object in an EEPROM wears it out: write on change, not in each scan.
struct EC_SdoWrite : ExecuteBlock<EC_SdoWrite> {
    DeviceRef Device{};
    bool Execute = false;
    std::uint16_t Index = 0;
    std::uint8_t SubIndex = 0;
    std::int64_t Value = 0;
    std::uint8_t Size = 4;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    std::uint32_t AbortCode = 0;

    detail::ObjectRequest request{};  ///< not a pin

    static constexpr std::string_view summary = "Writes an object of a slave (SDO download) without disturbing the cycle.";
    template <class Self>
    static consteval auto pins() {
        return std::array{
            in_out<&Self::Device>("", "slave that has the object"),
            in<&Self::Execute>("", "a rising edge starts; the inputs are taken then"),
            in<&Self::Index>("", "of the object, e.g. 607Fh"),
            in<&Self::SubIndex>("", "of the object"),
            in<&Self::Value>("", "what to write; its low Size bytes"),
            in<&Self::Size>("", "bytes of the object: 1 to 8, exactly as the slave has it"),
            out<&Self::Done>("", "the slave has taken the value"),
            out<&Self::Busy>("", "not finished"),
            out<&Self::Error>("", "refused, or no answer"),
            out<&Self::ErrorID>("", "why"),
            out<&Self::AbortCode>("", "the slave's SDO abort code; 0 = it did not refuse"),
        };
    }

private:
    friend ExecuteBlock<EC_SdoWrite>;
    void start(const MotionContext& ctx) noexcept {
        if (ctx.objects == nullptr) return core_.refuse(ErrorId::invalid_device);
        if (Size < 1 || Size > sizeof(Value)) return core_.refuse(ErrorId::invalid_parameter);
        request.drop(ctx);
        AbortCode = 0;
        std::array<std::byte, sizeof(Value)> bytes{};
        for (std::size_t i = 0; i < Size; ++i) bytes[i] = static_cast<std::byte>(static_cast<std::uint64_t>(Value) >> (8 * i));
        request.ticket = ctx.objects->write(Device, Index, SubIndex, std::span<const std::byte>{bytes}.first(Size));
        request.accept(ctx, core_, Device, Size);
    }
    void follow(const MotionContext& ctx) noexcept {
        request.follow(ctx, *this, core_, [this](std::span<const std::byte>) { core_.finish(); });
    }
};

}  // namespace taktwerk::fb
