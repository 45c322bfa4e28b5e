#pragma once
// An object of a device, read or written beside the cycle, for programs that want more than EC_SdoRead and EC_SdoWrite give: values
// of up to 256 bytes, and a form that reads like a sequence. Plain data, a member of the program. Real-time safe.
//
//   case read_serial:                                        case wait_serial:
//       serial_.read(ctx, drive_, 0x1018, 4);                    if (serial_.pending(ctx)) break;
//       step_ = wait_serial;                                     if (const auto number = serial_.value<std::uint32_t>(ctx)) use(*number);
//       break;                                                   else abort_ = serial_.answer(ctx).abort_code;

#include <concepts>
#include <optional>
#include <type_traits>

#include "core/object_access.hpp"
#include "programs/api/program.hpp"

namespace taktwerk {

class ObjectFuture {
public:
    /// Asks for the value; what was asked before is dropped.
    void read(const TaskContext& ctx, DeviceRef device, std::uint16_t index, std::uint8_t sub) noexcept {
        begin(ctx, device, 0);
        if (ctx.objects != nullptr) ticket_ = ctx.objects->read(device, index, sub);
    }
    /// 1 to object_data_limit bytes, little-endian, exactly as long as the object.
    void write(const TaskContext& ctx, DeviceRef device, std::uint16_t index, std::uint8_t sub, std::span<const std::byte> data) noexcept {
        begin(ctx, device, data.size());
        if (ctx.objects != nullptr) ticket_ = ctx.objects->write(device, index, sub, data);
    }
    template <std::integral T>
    void write(const TaskContext& ctx, DeviceRef device, std::uint16_t index, std::uint8_t sub, T value) noexcept {
        std::byte bytes[sizeof(T)];
        for (std::size_t i = 0; i < sizeof(T); ++i)
            bytes[i] = static_cast<std::byte>(static_cast<std::make_unsigned_t<T>>(value) >> (8 * i) & 0xFF);
        write(ctx, device, index, sub, std::span<const std::byte>{bytes});
    }

    [[nodiscard]] bool pending(const TaskContext& ctx) const noexcept { return answer(ctx).outcome == ObjectOutcome::pending; }
    /// What became of the last request; `unknown` before the first.
    [[nodiscard]] ObjectAnswer answer(const TaskContext& ctx) const noexcept {
        if (ticket_.valid()) return ctx.objects->answer(ticket_);
        ObjectAnswer refused;
        refused.outcome = refused_;
        return refused;
    }
    /// The value that was read, when it has exactly the size of T.
    template <std::integral T>
    [[nodiscard]] std::optional<T> value(const TaskContext& ctx) const noexcept {
        const ObjectAnswer now = answer(ctx);
        if (now.outcome != ObjectOutcome::done || now.data.size() != sizeof(T)) return std::nullopt;
        std::make_unsigned_t<T> bits = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i)
            bits = static_cast<std::make_unsigned_t<T>>(bits | (static_cast<std::make_unsigned_t<T>>(now.data[i]) << (8 * i)));
        return static_cast<T>(bits);
    }
    /// Gives the place back. Not needed before the next read() or write(), nor when the program stops.
    void drop(const TaskContext& ctx) noexcept {
        if (ticket_.valid() && ctx.objects != nullptr) ctx.objects->release(ticket_);
        ticket_ = {};
        refused_ = ObjectOutcome::unknown;
    }

private:
    void begin(const TaskContext& ctx, DeviceRef device, std::size_t size) noexcept {
        drop(ctx);
        refused_ = ctx.objects != nullptr ? ctx.objects->why(device, size) : ObjectOutcome::invalid_device;
    }

    ObjectTicket ticket_{};
    ObjectOutcome refused_ = ObjectOutcome::unknown;
};

}  // namespace taktwerk
