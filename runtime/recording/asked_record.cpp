#include "runtime/recording/asked_record.hpp"

#include <algorithm>

#include "core/bytes.hpp"

namespace taktwerk::runtime {

namespace {
constexpr std::size_t head = 7;
}

void record_asked(Recorder& recorder, Instant at, const AskedRecord& asked) {
    std::vector<std::byte> bytes(head);
    const std::span<std::byte> to{bytes};
    store_le(to, 0, static_cast<std::uint8_t>(asked.kind));
    store_le(to, 1, asked.axis);
    store_le(to, 3, asked.address.index);
    store_le(to, 5, asked.address.sub);
    store_le(to, 6, static_cast<std::uint8_t>(asked.service));
    bytes.insert(bytes.end(), asked.value.begin(),
                 asked.value.begin() + static_cast<std::ptrdiff_t>(std::min(asked.value.size(), most_asked_bytes)));
    recorder.append(asked_channel, at, bytes);
}

std::optional<AskedRecord> read_asked(std::span<const std::byte> bytes) {
    if (bytes.size() < head || bytes.size() > head + most_asked_bytes) return std::nullopt;
    const auto kind = load_le<std::uint8_t>(bytes), service = load_le<std::uint8_t>(bytes, 6);
    if (kind > static_cast<std::uint8_t>(AskedKind::ports) || service > static_cast<std::uint8_t>(axes::DriveService::restart))
        return std::nullopt;
    return AskedRecord{static_cast<AskedKind>(kind),
                       load_le<std::uint16_t>(bytes, 1),
                       {load_le<std::uint16_t>(bytes, 3), load_le<std::uint8_t>(bytes, 5)},
                       static_cast<axes::DriveService>(service),
                       {bytes.begin() + head, bytes.end()}};
}

}  // namespace taktwerk::runtime
