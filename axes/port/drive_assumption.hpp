#pragma once
// What is taken for granted of a drive that nobody described, and how a machine builder says otherwise. Plain data.

#include <cstdint>
#include <string>
#include <vector>

namespace taktwerk::axes {

/// What an assumption is about, as far as code asks. As long as one stands the drive's own word goes before the profile's.
enum class AssumedPart : std::uint8_t {
    other,
    identity,      ///< who it is
    controller,    ///< where its mailbox and sync managers lie
    process_data,  ///< which PDOs it has, and what may be changed
    modes,         ///< 6502h says which of the profile's modes it has
};

struct DriveAssumption {
    AssumedPart part = AssumedPart::other;
    std::string text{};                 ///< what is assumed, with the object
    std::string why{};                  ///< where it comes from
    std::string otherwise{};            ///< what to write where it is not so
    std::vector<std::string> unless{};  ///< keys of a drive file or of a slave that state it
};

}  // namespace taktwerk::axes
