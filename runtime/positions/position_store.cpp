#include "runtime/positions/position_store.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "core/crc32.hpp"

namespace taktwerk::runtime {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view first_line = "taktwerk positions 1";
constexpr unsigned slots = 2;
constexpr std::size_t largest_file = 1 << 20;                // some thousand axes
constexpr std::int64_t most_counts = std::int64_t{1} << 52;  // what a double still tells apart, with room to add

struct Slot {
    std::uint64_t number = 0;
    std::vector<RetainedAxis> axes;
};

std::uint32_t sum(std::string_view text) { return crc32(std::as_bytes(std::span(text.data(), text.size()))); }

/// Shortest text that reads back as the same number.
std::string exact(double value) {
    char text[40];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return {text, end};
}

std::string written(const Slot& slot) {
    std::string text = fmt::format("{}\nnumber {}\n", first_line, slot.number);
    for (const auto& axis : slot.axes) {
        const auto& p = axis.position;
        const auto& g = axis.gearing;
        text += fmt::format("axis {} homed {} shift {} counts {} at_rest {} gearing {} {} {} {} {}\n", axis.name, p.homed ? 1 : 0,
                            exact(p.shift), p.counts, p.at_rest ? 1 : 0, g.counts_per_revolution, g.motor_revolutions, g.load_revolutions,
                            exact(g.feed), g.inverted ? 1 : 0);
    }
    return text + fmt::format("crc {:08x}\n", sum(text));
}

/// Words of a slot, one after the other; once one does not fit, none does any more.
class Words {
public:
    explicit Words(std::string_view text) : rest_(text) {}

    std::string_view next() {
        const auto from = rest_.find_first_not_of(" \n");
        if (from == std::string_view::npos) {
            rest_ = {};
            return {};
        }
        const auto to = rest_.find_first_of(" \n", from);
        const auto word = rest_.substr(from, to == std::string_view::npos ? to : to - from);
        rest_ = to == std::string_view::npos ? std::string_view{} : rest_.substr(to);
        return word;
    }
    void expect(std::string_view word) { good_ = next() == word && good_; }
    template <class T>
    void read(T& out) {
        const auto word = next();
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), out);
        good_ = good_ && !word.empty() && error == std::errc{} && end == word.data() + word.size();
    }
    void read_bit(bool& out) {
        int value = 0;
        read(value);
        good_ = good_ && (value == 0 || value == 1);
        out = value == 1;
    }
    [[nodiscard]] bool at_end() const { return rest_.find_first_not_of(" \n") == std::string_view::npos; }
    [[nodiscard]] bool good() const { return good_; }

private:
    std::string_view rest_;
    bool good_ = true;
};

/// What some axis could have. A check sum says that nobody altered it by mistake, not that it makes sense.
bool possible(const RetainedAxis& axis) {
    const auto& p = axis.position;
    const auto& g = axis.gearing;
    const bool gearing =
        g.counts_per_revolution > 0 && g.motor_revolutions > 0 && g.load_revolutions > 0 && std::isfinite(g.feed) && g.feed > 0;
    if (!gearing || axis.name.empty() || !std::isfinite(p.shift)) return false;
    const bool resolved = std::abs(p.shift) / g.feed * static_cast<double>(g.counts_per_revolution) <= static_cast<double>(most_counts);
    return resolved && p.counts <= most_counts && p.counts >= -most_counts;
}

std::optional<Slot> parsed(std::string_view text) {
    const auto last = text.rfind("crc ");
    if (last == std::string_view::npos || text.substr(last) != fmt::format("crc {:08x}\n", sum(text.substr(0, last)))) return std::nullopt;
    Words words(text.substr(0, last));
    for (const auto word : {"taktwerk", "positions", "1", "number"}) words.expect(word);
    Slot slot;
    words.read(slot.number);
    while (words.good() && !words.at_end()) {
        RetainedAxis axis;
        auto& p = axis.position;
        auto& g = axis.gearing;
        words.expect("axis");
        axis.name = words.next();
        words.expect("homed"), words.read_bit(p.homed);
        words.expect("shift"), words.read(p.shift);
        words.expect("counts"), words.read(p.counts);
        words.expect("at_rest"), words.read_bit(p.at_rest);
        words.expect("gearing"), words.read(g.counts_per_revolution), words.read(g.motor_revolutions), words.read(g.load_revolutions);
        words.read(g.feed), words.read_bit(g.inverted);
        const bool again = std::any_of(slot.axes.begin(), slot.axes.end(), [&](const auto& other) { return other.name == axis.name; });
        if (!words.good() || again || !possible(axis)) return std::nullopt;
        slot.axes.push_back(std::move(axis));
    }
    if (!words.good() || slot.number == 0 || slot.number > std::numeric_limits<std::uint64_t>::max() / 2) return std::nullopt;
    return slot;
}

fs::path place(const fs::path& directory, unsigned slot) { return directory / fmt::format("positions.{}", slot); }

/// A file or folder whose changes shall be on the disk.
class Descriptor {
public:
    Descriptor(const fs::path& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0644)) {}
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    [[nodiscard]] bool write(std::string_view text) const {
        while (fd_ >= 0 && !text.empty()) {
            const auto done = ::write(fd_, text.data(), text.size());
            if (done < 0 && errno == EINTR) continue;
            if (done <= 0) return false;
            text.remove_prefix(static_cast<std::size_t>(done));
        }
        return fd_ >= 0;
    }
    [[nodiscard]] bool sync() const { return fd_ >= 0 && ::fsync(fd_) == 0; }

private:
    int fd_;
};

Error cannot_write(const fs::path& where, const std::string& why) {
    return {"positions.cannot_write", where.string(), "the positions of the axes cannot be kept: " + why,
            "give `retain` a directory on a disk with room that the runtime may write"};
}

}  // namespace

PositionStore::Loaded PositionStore::load() {
    Loaded loaded;
    number_ = 0;
    next_ = 0;
    for (unsigned s = 0; s < slots; ++s) {
        const auto path = place(directory_, s);
        std::ifstream file(path, std::ios::binary);
        if (!file) continue;
        std::string text(largest_file, '\0');
        file.read(text.data(), static_cast<std::streamsize>(text.size()));
        text.resize(static_cast<std::size_t>(file.gcount()));
        auto slot = parsed(text);
        if (!slot) {
            loaded.damage.push_back({"positions.damaged", path.string(), "the file is torn or altered",
                                     "nothing: the other slot is used where it is whole; home the axes that are not homed"});
            continue;
        }
        on_disk_[s] = slot->axes;
        if (slot->number < number_) continue;
        number_ = slot->number;
        next_ = (s + 1) % slots;
        loaded.axes = std::move(slot->axes);
    }
    loaded.lost = number_ == 0 && !loaded.damage.empty();
    return loaded;
}

Result<void> PositionStore::save(std::span<const RetainedAxis> axes) {
    auto written = write_next(axes);
    if (written && contradicts(next_, axes)) written = write_next(axes);
    bool outdated = false;
    for (unsigned s = 0; s < slots; ++s) {
        if (contradicts(s, axes)) take_back(s);
        outdated = outdated || contradicts(s, axes);
    }
    if (outdated && !written)
        return Error{"positions.outdated", directory_.string(),
                     "an older reference of an axis stands there and cannot be taken back: " + written.error().what,
                     "make it writable, or delete positions.0 and positions.1 before the next start"};
    return written;
}

bool PositionStore::contradicts(unsigned slot, std::span<const RetainedAxis> axes) const {
    const auto still_so = [&](const RetainedAxis& kept) {
        return std::any_of(axes.begin(), axes.end(), [&](const RetainedAxis& now) {
            return now.name == kept.name && now.position.homed && now.position.shift == kept.position.shift &&
                   axes::same_coordinates(now.gearing, kept.gearing);
        });
    };
    const auto& kept = on_disk_[slot];
    return !std::all_of(kept.begin(), kept.end(), [&](const RetainedAxis& axis) { return !axis.position.homed || still_so(axis); });
}

// A directory that takes no new file may let go of an old one, and one that does neither may hold files that can be emptied.
void PositionStore::take_back(unsigned slot) {
    const auto path = place(directory_, slot);
    std::error_code failed;
    fs::remove(path, failed);
    if (!failed) (void)Descriptor(directory_, O_RDONLY | O_DIRECTORY).sync();
    else if (!Descriptor(path, O_WRONLY | O_TRUNC | O_NOFOLLOW).sync()) return;
    on_disk_[slot].clear();
}

PositionStore::~PositionStore() {
    if (lock_ >= 0) ::close(lock_);
}

std::optional<Error> PositionStore::lock() {
    std::error_code failed;
    fs::create_directories(directory_, failed);
    const auto path = directory_ / "positions.lock";
    // For the owner alone: whoever can open it could hold it.
    const int lock = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (lock < 0) return std::nullopt;
    if (::flock(lock, LOCK_EX | LOCK_NB) != 0) {
        char pid[32] = {};
        const auto length = ::pread(lock, pid, sizeof pid - 1, 0);
        ::close(lock);
        return Error{"positions.in_use", directory_.string(),
                     fmt::format("process {} keeps the positions of its axes there already", length > 0 ? pid : "unknown"),
                     "Stop it first, or give this machine a directory of its own as `retain` (or --retain)."};
    }
    const auto pid = std::to_string(::getpid());
    if (::ftruncate(lock, 0) != 0 || ::pwrite(lock, pid.data(), pid.size(), 0) < 0) {
        // Only the message for a second runtime would be poorer.
    }
    lock_ = lock;
    return std::nullopt;
}

Result<void> PositionStore::write_next(std::span<const RetainedAxis> axes) {
    std::error_code failed;
    fs::create_directories(directory_, failed);
    if (failed) return cannot_write(directory_, failed.message());
    const auto path = place(directory_, next_);
    const auto beside = fs::path(path.string() + ".new");
    {
        const Descriptor file(beside, O_WRONLY | O_CREAT | O_TRUNC);
        if (!file.write(written({number_ + 1, {axes.begin(), axes.end()}})) || !file.sync())
            return cannot_write(beside, std::strerror(errno));
    }
    fs::rename(beside, path, failed);
    if (failed) return cannot_write(path, failed.message());
    on_disk_[next_].assign(axes.begin(), axes.end());
    if (!Descriptor(directory_, O_RDONLY | O_DIRECTORY).sync()) return cannot_write(directory_, std::strerror(errno));
    ++number_;
    next_ = (next_ + 1) % slots;
    return {};
}

}  // namespace taktwerk::runtime
