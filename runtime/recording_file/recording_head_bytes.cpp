#include "runtime/recording_file/recording_head_bytes.hpp"

#include <algorithm>
#include <string_view>

#include "core/bytes.hpp"

namespace taktwerk::runtime {

namespace {

void put_number(std::vector<std::byte>& to, std::size_t value) {
    to.resize(to.size() + 2);
    store_le(std::span{to}, to.size() - 2, static_cast<std::uint16_t>(value));
}

void put_text(std::vector<std::byte>& to, std::string_view text) {
    const std::size_t length = std::min<std::size_t>(text.size(), 0xFFFF);
    put_number(to, length);
    const auto all = std::as_bytes(std::span{text.data(), length});
    to.insert(to.end(), all.begin(), all.end());
}

/// Past the end everything is empty and ok() false.
class Reader {
public:
    explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}
    std::size_t number() {
        if (rest_.size() < 2) return ok_ = false, 0;
        const auto value = load_le<std::uint16_t>(rest_);
        rest_ = rest_.subspan(2);
        return value;
    }
    std::string text() {
        const std::size_t length = number();
        if (rest_.size() < length) return ok_ = false, std::string{};
        std::string out(length, '\0');
        std::transform(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(length), out.begin(),
                       [](std::byte b) { return static_cast<char>(b); });
        rest_ = rest_.subspan(length);
        return out;
    }
    [[nodiscard]] bool ok() const { return ok_; }

private:
    std::span<const std::byte> rest_;
    bool ok_ = true;
};

}  // namespace

std::vector<std::byte> head_bytes(const RecordingInfo& info) {
    std::vector<std::byte> bytes;
    put_number(bytes, info.facts.size());
    for (const auto& [name, value] : info.facts) {
        put_text(bytes, name);
        put_text(bytes, value);
    }
    put_number(bytes, info.channels.size());
    for (const auto& channel : info.channels) put_text(bytes, channel);
    return bytes;
}

std::optional<RecordingInfo> read_head_bytes(std::span<const std::byte> bytes) {
    RecordingInfo info;
    Reader reader{bytes};
    for (std::size_t left = reader.number(); left > 0 && reader.ok(); --left) {
        std::string fact = reader.text();
        info.facts.emplace_back(std::move(fact), reader.text());
    }
    for (std::size_t left = reader.number(); left > 0 && reader.ok(); --left) info.channels.push_back(reader.text());
    if (!reader.ok()) return std::nullopt;
    return info;
}

}  // namespace taktwerk::runtime
