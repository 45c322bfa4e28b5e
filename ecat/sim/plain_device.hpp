#pragma once
// A simulated device that is no drive: what hands put into its objects goes to the master, and what the master sends can be looked at. With
// or without a mailbox. Outputs fall to 0 when the SM watchdog expires and whenever the device is not in OP. Real-time safe except
// construction and power_on().

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/process_image.hpp"
#include "ecat/description/device_description.hpp"
#include "ecat/sim/device_model.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::ecat::sim {

class PlainDevice final : public DeviceModel {
public:
    explicit PlainDevice(const DeviceDescription& description);

    /// What the field gives an input object from now on, raw; sampled at the next exchange. Unknown objects: nothing happens.
    void set(std::uint16_t index, std::uint8_t sub, std::int64_t value) noexcept;
    /// What an object of the process data has now, raw. Unknown: 0.
    [[nodiscard]] std::int64_t get(std::uint16_t index, std::uint8_t sub) const noexcept;

    void power_on(ObjectDictionary& dictionary, Instant now) override;
    void power_off(Instant) override { clear_outputs(); }
    void entered(EsmState state, Instant) override {
        if (state != EsmState::op) clear_outputs();
    }
    void exchange(Instant) override;
    void outputs_lost(Instant) override { clear_outputs(); }
    void raw_outputs(std::span<const std::byte> outputs) override;
    void raw_inputs(std::span<std::byte> inputs) override;

private:
    struct Object {
        std::uint16_t index = 0;
        std::uint8_t sub = 0;
        bool output = false;
        Signal signal{};  ///< in the raw process data of a device without a dictionary
        Entry* entry = nullptr;
        std::int64_t value = 0;
    };
    void clear_outputs() noexcept;
    [[nodiscard]] const Object* find(std::uint16_t index, std::uint8_t sub) const noexcept;

    bool has_dictionary_;
    std::vector<Object> objects_;
};

}  // namespace taktwerk::ecat::sim
