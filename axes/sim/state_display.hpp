#pragma once
// State, present error and earlier errors on objects of the drive's own. Which objects they are comes from DriveProfile::behaviour.state.
// Source: SE-808X 4.4 (2001h:01, :02, :04, :09 to :0E). What its manual leaves open: the records are those of all errors, not of those of
// communication only, as the word for the pointer has it; they are error codes as in 603Fh; they outlive a power cycle.

#include <cstdint>
#include <vector>

#include "axes/port/drive_setting.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::axes::sim {

class StateDisplay {
public:
    StateDisplay(const StateObjects& objects, std::uint16_t communication_code)
        : objects_(objects), communication_code_(communication_code), records_(objects.history_length, 0) {}

    void power_on(ecat::sim::ObjectDictionary& dictionary);
    /// Each exchange. `code` 0: no error; `detail` of a communication error. Real-time safe.
    void show(bool powered, std::uint16_t code, std::uint32_t detail) noexcept;
    /// An error has come. Real-time safe.
    void remember(std::uint16_t code) noexcept;

private:
    using Entry = ecat::sim::Entry;
    void show_records() noexcept;

    const StateObjects objects_;
    std::uint16_t communication_code_;
    std::vector<std::uint16_t> records_;  ///< a ring
    std::size_t next_ = 0;
    Entry *state_ = nullptr, *code_ = nullptr, *sub_code_ = nullptr, *next_entry_ = nullptr;
    std::vector<Entry*> record_entries_;
};

}  // namespace taktwerk::axes::sim
