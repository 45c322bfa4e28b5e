#pragma once
// Objects of the inputs that say what a hand gives them, whatever the drive would say: a sensor at a device that is described as a drive, an
// analog value.

#include <cstdint>
#include <vector>

#include "axes/sim/set_if_there.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::axes::sim {

class HeldInputs {
public:
    void power_on(ecat::sim::ObjectDictionary& dictionary) {
        dictionary_ = &dictionary;
        for (auto& held : held_) held.entry = dictionary.find(held.index, held.sub);
    }
    /// From now on.
    void hold(std::uint16_t index, std::uint8_t sub, std::int64_t value) {
        for (auto& held : held_)
            if (held.index == index && held.sub == sub) {
                held.value = value;
                return;
            }
        held_.push_back({index, sub, value, dictionary_ ? dictionary_->find(index, sub) : nullptr});
    }
    /// At the end of each exchange.
    void show() const noexcept {
        for (const auto& held : held_) set_if_there(held.entry, held.value);
    }

private:
    struct Held {
        std::uint16_t index;
        std::uint8_t sub;
        std::int64_t value;
        ecat::sim::Entry* entry;
    };
    std::vector<Held> held_;
    ecat::sim::ObjectDictionary* dictionary_ = nullptr;
};

}  // namespace taktwerk::axes::sim
