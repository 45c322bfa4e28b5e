#pragma once
// Positions of axes with absolute encoders, kept in a directory over a time without power.
//
// Two slots, positions.0 and positions.1, written in turn: while one is written the other stays whole. A slot is written beside its place,
// synchronised to the disk and then moved there, so a power cut leaves the old one or the new one. The slot with the higher number counts;
// one that is torn or altered is recognised by its check sum, and the other is used. Once a reference has changed, both are written: nothing
// that could be read again names the old one; where neither can be written, what names it is removed or emptied. Text, one line each:
//
//     taktwerk positions 1                 format and version
//     number 17                            rises with each writing
//     axis x homed 1 shift 12.5 counts -4711 at_rest 1 gearing 10000 1 1 10 0
//     crc 1a2b3c4d                         CRC-32 (IEEE 802.3) of all bytes before this line
//
// shift [u] is the coordinate of count 0, counts [counts] where the axis was, unwrapped; gearing: counts_per_revolution, motor and load
// revolutions, feed [u], inverted. Numbers are written so that they read back as the very same; such that no axis can have (not finite, beyond
// what its counts resolve) are damage, whatever the check sum says. One process at a time has the directory: positions.lock. Not real-time.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "axes/axis/retained_position.hpp"
#include "core/result.hpp"

namespace taktwerk::runtime {

struct RetainedAxis {
    std::string name;
    axes::RetainedPosition position;
    axes::Gearing gearing;
};

class PositionStore {
public:
    explicit PositionStore(std::filesystem::path directory) : directory_(std::move(directory)) {}
    ~PositionStore();
    PositionStore(const PositionStore&) = delete;
    PositionStore& operator=(const PositionStore&) = delete;

    /// Makes the directory and keeps everybody else out of it for as long as the store lives. Nothing where it cannot be written: save()
    /// says that. Errors: positions.in_use, with the process that has it.
    [[nodiscard]] std::optional<Error> lock();

    struct Loaded {
        std::vector<RetainedAxis> axes;
        std::vector<Error> damage;  ///< one for each slot that cannot be used
        bool lost = false;          ///< there was something, and none of it can be used
    };
    /// Before the first save. An empty or missing directory is an empty, healthy store.
    [[nodiscard]] Loaded load();
    /// Errors, with the reason of the system: positions.cannot_write; positions.outdated where a slot moreover names a reference that holds
    /// no more and cannot be taken back either. A slot that says nothing wrong stays.
    [[nodiscard]] Result<void> save(std::span<const RetainedAxis> axes);

    [[nodiscard]] const std::filesystem::path& directory() const noexcept { return directory_; }

private:
    [[nodiscard]] Result<void> write_next(std::span<const RetainedAxis> axes);
    /// What `slot` says of some axis is not so any more.
    [[nodiscard]] bool contradicts(unsigned slot, std::span<const RetainedAxis> axes) const;
    void take_back(unsigned slot);

    std::filesystem::path directory_;
    int lock_ = -1;
    std::array<std::vector<RetainedAxis>, 2> on_disk_;  // per slot, as a load() would find it
    std::uint64_t number_ = 0;
    unsigned next_ = 0;  // slot
};

}  // namespace taktwerk::runtime
