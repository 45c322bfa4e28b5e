#include "runtime/retain/retain_store.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "runtime/retain/kept_text.hpp"

namespace taktwerk::runtime {

namespace {

namespace fs = std::filesystem;

fs::path old_place(const fs::path& directory, unsigned slot) { return directory / fmt::format("positions.{}", slot); }

}  // namespace

RetainStore::Loaded RetainStore::load() {
    Loaded loaded;
    number_ = 0;
    next_ = 0;
    bool any = false;
    std::array<Result<std::optional<std::string>>, SlotFiles::count> texts{SlotFiles::read(files_.place(0)),
                                                                           SlotFiles::read(files_.place(1))};
    for (const auto& text : texts) any = any || !text || text->has_value();
    for (unsigned s = 0; s < SlotFiles::count; ++s) {
        const auto path = any ? files_.place(s) : old_place(directory(), s);
        const auto text = any ? std::move(texts[s]) : SlotFiles::read(path);
        on_disk_[s].clear();
        old_[s] = !any && text && text->has_value();
        unread_[s] = any && !text;
        if (!text) loaded.damage.push_back(text.error());
        if (!text || !text->has_value()) continue;
        auto kept = kept_of(**text);
        if (!kept) {
            loaded.damage.push_back({"retain.damaged", path.string(), "the file is torn or altered",
                                     "nothing: the other slot is used where it is whole; home the axes that are not homed"});
            continue;
        }
        on_disk_[s] = kept->axes;
        if (kept->number < number_) continue;
        number_ = kept->number;
        next_ = (s + 1) % SlotFiles::count;
        loaded.kept = std::move(*kept);
    }
    loaded.lost = number_ == 0 && !loaded.damage.empty();
    return loaded;
}

Result<void> RetainStore::save(Kept kept) {
    auto written = write_next(kept);
    if (written && contradicts(next_, kept.axes)) written = write_next(kept);
    bool outdated = false;
    for (unsigned s = 0; s < SlotFiles::count; ++s) {
        const bool gone = contradicts(s, kept.axes) && files_.take_back(old_[s] ? old_place(directory(), s) : files_.place(s));
        if (gone) on_disk_[s].clear();
        outdated = outdated || contradicts(s, kept.axes);
    }
    if (outdated && !written)
        return Error{"retain.outdated", directory().string(),
                     "an older reference of an axis stands there and cannot be taken back: " + written.error().what,
                     "make it writable, or delete retain.0 and retain.1 before the next start"};
    return written;
}

bool RetainStore::contradicts(unsigned slot, std::span<const RetainedAxis> axes) const {
    const auto still_so = [&](const RetainedAxis& kept) {
        return std::any_of(axes.begin(), axes.end(), [&](const RetainedAxis& now) {
            return now.name == kept.name && now.position.homed && now.position.shift == kept.position.shift &&
                   axes::same_coordinates(now.gearing, kept.gearing);
        });
    };
    const auto& kept = on_disk_[slot];
    return !std::all_of(kept.begin(), kept.end(), [&](const RetainedAxis& axis) { return !axis.position.homed || still_so(axis); });
}

Result<void> RetainStore::write_next(Kept& kept) {
    kept.number = number_ + 1;
    const auto text = text_of(kept);
    if (!kept_of(text))
        return Error{
            "retain.not_readable", directory().string(),
            fmt::format("it could not be read again: more than {} values, blocks or parameters, or two of one name", most_kept_items),
            "nothing was changed: keep less"};
    // All of them at once: one that can be read again at the next start would win by its number over what has been written since.
    for (unsigned s = 0; s < SlotFiles::count; ++s)
        if (std::exchange(unread_[s], false)) SlotFiles::set_aside(files_.place(s));
    if (auto done = files_.write(next_, text); !done) return done;
    on_disk_[next_] = kept.axes;
    // Nobody but an older runtime reads its files from here on.
    for (unsigned s = 0; s < SlotFiles::count; ++s) {
        if (!old_[s]) continue;
        (void)files_.take_back(old_place(directory(), s));
        old_[s] = false;
        if (s != next_) on_disk_[s].clear();
    }
    ++number_;
    next_ = (next_ + 1) % SlotFiles::count;
    return {};
}

}  // namespace taktwerk::runtime
