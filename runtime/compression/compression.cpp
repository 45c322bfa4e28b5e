#include "runtime/compression/compression.hpp"

#include <zstd.h>

#include <new>

namespace taktwerk::runtime {

namespace {
constexpr int level = 3;
}

std::size_t compressed_bound(std::size_t bytes) noexcept { return ZSTD_compressBound(bytes); }

void compress(std::span<const std::byte> bytes, std::vector<std::byte>& to) {
    const auto before = to.size();
    to.resize(before + compressed_bound(bytes.size()));
    const auto length = ZSTD_compress(to.data() + before, to.size() - before, bytes.data(), bytes.size(), level);
    if (ZSTD_isError(length) != 0) throw std::bad_alloc{};  // into room enough nothing else can fail
    to.resize(before + length);
}

std::optional<std::size_t> size_before_compression(std::span<const std::byte> packed) noexcept {
    const auto size = ZSTD_getFrameContentSize(packed.data(), packed.size());
    if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR) return std::nullopt;
    return size;
}

bool decompress(std::span<const std::byte> packed, std::span<std::byte> to) noexcept {
    return ZSTD_decompress(to.data(), to.size(), packed.data(), packed.size()) == to.size();
}

}  // namespace taktwerk::runtime
