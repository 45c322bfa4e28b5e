#include "ecat/bringup/sii_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration poll_period = std::chrono::microseconds{200};
constexpr Duration retry_period = std::chrono::milliseconds{5};
constexpr std::size_t words_per_kbit = 64;
constexpr std::size_t usual_words = 1024;  ///< 16 kbit: where the header does not say, or says nonsense
constexpr std::uint16_t most_size_code = 0x0FFF;

Error sii_error(const std::string& subject, std::size_t word, std::string what) {
    return Error{"bus.sii", subject, fmt::format("EEPROM word {:04X}h cannot be read: {}", word, what),
                 "power-cycle the slave; if it stays, its EEPROM is empty or defective"};
}

/// `owner`: 0500h in the low byte says what a master has granted, 0501h in the high one that the processor is at it.
Error taken_by_processor(const std::string& subject, std::uint16_t owner) {
    const bool granted = (owner & 1u) != 0;
    return Error{"bus.sii_taken", subject,
                 fmt::format("its EEPROM is in the hands of its own processor (0500h = {:02X}h, 0501h = {:02X}h): no master can read it",
                             owner & 0xFFu, owner >> 8),
                 granted ? "another master left it so; `taktwerk bus state init` or a bring-up takes it back"
                         : "power-cycle the slave; if it stays so its firmware keeps the EEPROM to itself"};
}

/// What one command delivered.
struct Words {
    std::array<std::uint16_t, 4> words{};
    std::size_t count = 0;  ///< 2 or 4
};

/// One read command. `idle`: the one before was answered, so the interface need not be asked first.
Script<Result<Words>> read_words(DatagramPort& port, std::uint16_t station, std::size_t word, bool idle, std::string subject) {
    Instant started = co_await time();
    std::vector<std::byte> request(6);
    store_le(request, 0, eeprom::read);
    store_le(request, 2, static_cast<std::uint32_t>(word));
    bool asked = false;
    if (idle) {
        const Reply written = co_await port.fpwr(station, reg::eeprom_control, request);
        if (!written.ok()) co_return unanswered(subject, "EEPROM (0502h)", written);
        asked = true;
    }
    for (unsigned refusals = 0;;) {
        const Reply reply = co_await port.fprd(station, reg::eeprom_control, 14);
        if (!reply.ok()) co_return unanswered(subject, "EEPROM (0502h)", reply);
        started += reply.queued;
        const std::uint16_t control = reply.u16();
        const bool busy = (control & eeprom::busy) != 0;
        const bool refused = (control & (eeprom::command_error | eeprom::write_enable_error)) != 0;
        if (!busy && asked && !refused && reply.u32(2) == word) {
            Words found;
            found.count = (control & eeprom::reads_8_bytes) != 0 ? 4 : 2;
            for (std::size_t i = 0; i < found.count; ++i) found.words[i] = reply.u16(6 + 2 * i);
            co_return found;
        }
        const Instant now = co_await time();
        if (busy && now - started >= sii_busy_limit)
            co_return sii_error(subject, word,
                                fmt::format("the EEPROM stays busy for {} ms", (now - started) / std::chrono::milliseconds{1}));
        if (busy) {
            co_await pause(poll_period);
            continue;
        }
        if (asked && ++refusals > sii_retries && !refused) {
            const Reply owner = co_await port.fprd(station, reg::eeprom_configuration, 2);
            if (owner.ok() && (owner.u16() & 0x0101u) != 0) co_return taken_by_processor(subject, owner.u16());
            co_return sii_error(subject, word, fmt::format("the controller does not carry out the command (0502h = {:04X}h)", control));
        }
        if (asked && refusals > sii_retries)
            co_return sii_error(subject, word, fmt::format("the controller reports an error (0502h = {:04X}h)", control));
        if (asked) co_await pause(retry_period);
        const Reply written = co_await port.fpwr(station, reg::eeprom_control, request);
        if (!written.ok()) co_return unanswered(subject, "EEPROM (0502h)", written);
        asked = true;
    }
}

Script<void> read_answer(DatagramPort& port, std::uint16_t station, Reply& reply) {
    reply = co_await port.fprd(station, reg::eeprom_control, 14);
}

Script<void> write_command(DatagramPort& port, std::uint16_t station, std::size_t word, bool& written) {
    std::vector<std::byte> request(6);
    store_le(request, 0, eeprom::read);
    store_le(request, 2, static_cast<std::uint32_t>(word));
    const Reply reply = co_await port.fpwr(station, reg::eeprom_control, request);
    written = reply.ok();
}

/// The image as far as it was fetched. Words that nobody asked for are 0.
class Fetcher {
public:
    Fetcher(DatagramPort& port, std::uint16_t station, std::string subject)
        : port_(port), station_(station), subject_(std::move(subject)) {}

    /// Makes words [first, first + count) known. The answer to one command and the next command travel in the same frame; an
    /// EEPROM that is not ready by then is waited for instead.
    Script<Result<void>> fetch(std::size_t first, std::size_t count) {
        const std::size_t end = first + count;
        for (std::size_t word = next_unknown(first, end); word < end; word = next_unknown(word, end)) {
            if (asked_ == word && !slow_) {
                const std::size_t next = next_unknown(word + width_, end);
                const Words found = co_await take(word, next < end ? std::optional{next} : std::nullopt);
                if (found.count != 0) {
                    keep(word, found);
                    continue;
                }
                slow_ = ++missed_ > 2;
            }
            const Result<Words> read = co_await read_words(port_, station_, word, idle_, subject_);
            idle_ = static_cast<bool>(read);
            if (!read) co_return read.error();
            keep(word, *read);
            width_ = read->count;
            const std::size_t next = next_unknown(word, end);
            if (slow_ || next >= end) continue;
            co_await write_command(port_, station_, next, idle_);
            if (idle_) asked_ = next;
        }
        co_return Result<void>{};
    }
    [[nodiscard]] std::uint16_t word(std::size_t address) const noexcept {
        return 2 * address + 2 <= image_.size() ? load_le<std::uint16_t>(image_, 2 * address) : std::uint16_t{0};
    }
    /// The image ends here: what a wide read brought of the words behind it is none of it.
    void cut(std::size_t words) { image_.resize(std::min(image_.size(), 2 * words)); }
    [[nodiscard]] const std::vector<std::byte>& image() const noexcept { return image_; }

private:
    [[nodiscard]] std::size_t next_unknown(std::size_t from, std::size_t end) const noexcept {
        while (from < end && from < known_.size() && known_[from]) ++from;
        return from;
    }

    /// The answer to the command for `word`, which was given before, and the command for `next`. Count 0: not ready.
    Script<Words> take(std::size_t word, std::optional<std::size_t> next) {
        Reply reply;
        bool written = false;
        std::vector<Script<void>> both;
        both.push_back(read_answer(port_, station_, reply));
        if (next) both.push_back(write_command(port_, station_, *next, written));
        co_await all(std::move(both));
        Words found;
        asked_.reset();
        idle_ = false;
        if (!reply.ok()) co_return found;
        const std::uint16_t control = reply.u16();
        constexpr std::uint16_t trouble = eeprom::busy | eeprom::command_error | eeprom::write_enable_error;
        if ((control & trouble) != 0 || reply.u32(2) != word) co_return found;
        found.count = (control & eeprom::reads_8_bytes) != 0 ? 4 : 2;
        for (std::size_t i = 0; i < found.count; ++i) found.words[i] = reply.u16(6 + 2 * i);
        idle_ = !next || written;
        if (written) asked_ = next;
        co_return found;
    }

    void keep(std::size_t first, const Words& read) {
        const std::size_t end = first + read.count;
        if (known_.size() < end) known_.resize(end, false);
        if (image_.size() < 2 * end) image_.resize(2 * end);
        for (std::size_t i = 0; i < read.count; ++i) {
            known_[first + i] = true;
            store_le(image_, 2 * (first + i), read.words[i]);
        }
    }

    DatagramPort& port_;
    std::uint16_t station_;
    std::string subject_;
    std::vector<std::byte> image_;
    std::vector<bool> known_;
    std::optional<std::size_t> asked_;  ///< the command for this word is under way
    std::size_t width_ = 2;             ///< words a command delivers
    unsigned missed_ = 0;               ///< answers that were not ready when they were fetched
    bool slow_ = false;                 ///< slower than a frame's way out and back: every answer is waited for
    bool idle_ = false;                 ///< the interface takes a command without being asked first
};

/// Words that the EEPROM has by its own word 3Eh.
std::size_t device_words(std::uint16_t size_code) noexcept {
    return size_code == 0 || size_code > most_size_code ? usual_words : (size_code + 1u) * words_per_kbit;
}

/// The parts of the header that mean something (sii_word); the rest is reserved.
Script<Result<void>> fetch_header(Fetcher& eeprom) {
    Result<void> done = co_await eeprom.fetch(0, sii_word::serial + 2u);
    if (!done) co_return done;
    done = co_await eeprom.fetch(sii_word::boot_mailbox_out, sii_word::mailbox_protocols + 1u - sii_word::boot_mailbox_out);
    if (!done) co_return done;
    co_return co_await eeprom.fetch(sii_word::size, 2);
}

Script<Result<void>> fetch_categories(Fetcher& eeprom) {
    const std::size_t end = device_words(eeprom.word(sii_word::size));
    for (std::size_t at = sii_word::categories; at + 2 <= end;) {
        const Result<void> header = co_await eeprom.fetch(at, 2);
        if (!header) co_return header;
        const std::uint16_t type = eeprom.word(at), words = eeprom.word(at + 1);
        if (type == sii_category::end || (type == sii_category::nop && words == 0)) {
            eeprom.cut(at + 1);
            co_return Result<void>{};
        }
        const std::size_t there = std::min<std::size_t>(words, end - (at + 2));
        if (is_decoded(type)) {
            const Result<void> content = co_await eeprom.fetch(at + 2, there);
            if (!content) co_return content;
        }
        at += 2 + there;
        if (there < words) break;
    }
    eeprom.cut(end);
    co_return Result<void>{};
}

}  // namespace

Script<Result<std::uint32_t>> read_sii(DatagramPort& port, std::uint16_t station, std::uint16_t word, std::string subject) {
    const Result<Words> read = co_await read_words(port, station, word, false, std::move(subject));
    if (!read) co_return read.error();
    co_return read->words[0] | (std::uint32_t{read->words[1]} << 16);
}

Script<Result<Sii>> read_whole_sii(DatagramPort& port, std::uint16_t station, std::string subject) {
    Fetcher eeprom{port, station, std::move(subject)};
    const Result<void> header = co_await fetch_header(eeprom);
    if (!header) co_return header.error();
    const auto first = eeprom.word(sii_word::vendor);
    const bool blank =
        first == eeprom.word(sii_word::product) && (first == 0 || first == 0xFFFF) && eeprom.word(sii_word::checksum) == first;
    if (blank) co_return parse_sii({});
    const Result<void> categories = co_await fetch_categories(eeprom);
    Sii sii = parse_sii(eeprom.image());
    if (!categories) sii.defects.push_back(SiiDefect::unreadable);
    co_return sii;
}

Script<Result<std::vector<std::byte>>> read_eeprom(DatagramPort& port, std::uint16_t station, std::string subject,
                                                   std::optional<std::size_t> words) {
    Fetcher eeprom{port, station, std::move(subject)};
    const Result<void> size = co_await eeprom.fetch(sii_word::size - 2u, 4);  // with the two before: a whole access of 8 bytes
    if (!size) co_return size.error();
    const std::size_t count = words ? *words : device_words(eeprom.word(sii_word::size));
    const Result<void> all_of_it = co_await eeprom.fetch(0, count);
    if (!all_of_it) co_return all_of_it.error();
    eeprom.cut(count);
    co_return eeprom.image();
}

}  // namespace taktwerk::ecat
