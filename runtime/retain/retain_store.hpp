#pragma once
// What is kept, in a directory: two slots, retain.0 and retain.1, written in turn (slot_files.hpp; their text: kept_text.hpp). The slot with the
// higher number counts; one that is torn or altered is recognised by its check sum, and the other is used. Where neither is there, positions.0
// and positions.1 of an older runtime are read, and taken back once something newer stands there.
//
// Once the reference of an axis has changed, both slots are written: nothing that could be read again names the old one; where neither can be
// written, what names it is removed or emptied. Not real-time.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "core/result.hpp"
#include "runtime/retain/kept.hpp"
#include "runtime/retain/slot_files.hpp"

namespace taktwerk::runtime {

class RetainStore {
public:
    explicit RetainStore(std::filesystem::path directory) : files_(std::move(directory)) {}

    /// As SlotFiles::lock().
    [[nodiscard]] std::optional<Error> lock() { return files_.lock(); }

    struct Loaded {
        Kept kept;
        std::vector<Error> damage;  ///< one for each slot that cannot be used: retain.damaged, retain.unreadable
        bool lost = false;          ///< there was something, and none of it can be used
    };
    /// Before the first save. An empty or missing directory is an empty, healthy store.
    [[nodiscard]] Loaded load();
    /// Errors, with the reason of the system: retain.cannot_write; retain.outdated where a slot moreover names a reference of an axis that
    /// holds no more and cannot be taken back either; retain.not_readable, before anything is touched: it is more than a file may hold. A slot that
    /// says nothing wrong stays, and one that could not be read is kept beside its place (SlotFiles::set_aside).
    [[nodiscard]] Result<void> save(Kept kept);

    [[nodiscard]] const std::filesystem::path& directory() const noexcept { return files_.directory(); }

private:
    [[nodiscard]] Result<void> write_next(Kept& kept);
    /// What `slot` says of some axis is not so any more.
    [[nodiscard]] bool contradicts(unsigned slot, std::span<const RetainedAxis> axes) const;

    SlotFiles files_;
    std::array<std::vector<RetainedAxis>, SlotFiles::count> on_disk_;  // per slot, as a load() would find it
    std::array<bool, SlotFiles::count> old_{};                         // it stands in a file of an older runtime
    std::array<bool, SlotFiles::count> unread_{};                      // something is there, whatever it says
    std::uint64_t number_ = 0;
    unsigned next_ = 0;  // slot
};

}  // namespace taktwerk::runtime
