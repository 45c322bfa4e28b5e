#pragma once
// Access to the objects of a device on a fieldbus (SDO, parameters), asked for from a task: the request travels beside the
// cycle, process data never notices, the answer comes some scans later. No wait, no allocation; every function is real-time safe.
//
//     const ObjectTicket ticket = objects.read(drive, 0x6041, 0);
//     ... in later scans:
//     const ObjectAnswer answer = objects.answer(ticket);
//     if (answer.outcome != ObjectOutcome::pending) { use(answer); objects.release(ticket); }
//
// A ticket holds one of few places until it is released; those of a program that starts anew are released. An old ticket stays harmless.

#include <cstddef>
#include <cstdint>
#include <span>

namespace taktwerk {

/// A device by handle: Declaration::device() gives it.
struct DeviceRef {
    std::uint16_t index = 0xFFFF;
    friend bool operator==(DeviceRef, DeviceRef) = default;
};

/// A request under way. generation 0: none.
struct ObjectTicket {
    std::uint16_t place = 0;
    std::uint32_t generation = 0;
    [[nodiscard]] constexpr bool valid() const noexcept { return generation != 0; }
    friend bool operator==(ObjectTicket, ObjectTicket) = default;
};

enum class ObjectOutcome : std::uint8_t {
    pending,         ///< asked, not answered yet
    done,            ///< read: `data` holds the value; written: the device took it
    refused,         ///< the device aborted it: `abort_code` says why
    no_answer,       ///< the device is not reachable, or did not answer in time
    too_long,        ///< the value has more than object_data_limit bytes
    no_place,        ///< too many requests of this program are under way
    invalid_device,  ///< the handle names no device
    unknown,         ///< no such request: never made, or released
};

/// Bytes that one request carries at most.
inline constexpr std::size_t object_data_limit = 256;

struct ObjectAnswer {
    ObjectOutcome outcome = ObjectOutcome::unknown;
    std::uint32_t abort_code = 0;     ///< of `refused`; CoE: the SDO abort code
    std::span<const std::byte> data;  ///< of a read; little-endian as the device sent it; valid until release()
};

class ObjectAccess {
public:
    /// A ticket without generation says no_place or invalid_device: why() tells which.
    virtual ObjectTicket read(DeviceRef device, std::uint16_t index, std::uint8_t sub) noexcept = 0;
    /// `data`: 1 to object_data_limit bytes, little-endian, exactly as long as the object.
    virtual ObjectTicket write(DeviceRef device, std::uint16_t index, std::uint8_t sub, std::span<const std::byte> data) noexcept = 0;
    /// Why a request for this device would get no ticket now: no_place, invalid_device, too_long for `size`, else pending.
    [[nodiscard]] virtual ObjectOutcome why(DeviceRef device, std::size_t size) const noexcept = 0;
    /// In a base task it changes only between scans.
    [[nodiscard]] virtual ObjectAnswer answer(ObjectTicket ticket) const noexcept = 0;
    virtual void release(ObjectTicket ticket) noexcept = 0;

protected:
    ~ObjectAccess() = default;
};

}  // namespace taktwerk
