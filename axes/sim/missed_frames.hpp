#pragma once
// SYNC0 that found no new outputs, so often in a row that the drive gives up. Source: TSVM 7.1.1, alarm 21: "in OP more than three bad frames in
// a row".

#include <cstdint>

#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::axes::sim {

class MissedFrames {
public:
    /// 0: not counted.
    explicit MissedFrames(std::uint8_t allowed) noexcept : allowed_(allowed) {}

    void power_on(ecat::sim::ObjectDictionary& dictionary) {
        counter_ = dictionary.find(0x1C32, 0x0B);
        before_ = counter_ ? counter_->get() : 0;
        in_a_row_ = 0;
    }
    /// Each exchange; true: this one is too many.
    bool count(bool operational) noexcept {
        if (allowed_ == 0 || counter_ == nullptr) return false;
        const auto missed = counter_->get();
        in_a_row_ = operational && missed != before_ ? in_a_row_ + 1 : 0;
        before_ = missed;
        return in_a_row_ == allowed_ + 1u;
    }

private:
    std::uint8_t allowed_;
    ecat::sim::Entry* counter_ = nullptr;
    std::int64_t before_ = 0;
    std::uint32_t in_a_row_ = 0;
};

}  // namespace taktwerk::axes::sim
