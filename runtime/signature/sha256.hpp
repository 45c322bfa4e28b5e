#pragma once
// SHA-256 (FIPS 180-4) of bytes that come in parts. Not real-time.

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace taktwerk::runtime {

class Sha256 {
public:
    static constexpr std::size_t size = 32;
    using Digest = std::array<std::byte, size>;

    Sha256();
    ~Sha256();
    Sha256(const Sha256&) = delete;
    Sha256& operator=(const Sha256&) = delete;

    void add(std::span<const std::byte> part);
    /// Of everything that was added; nothing may be added afterwards.
    [[nodiscard]] Digest finish();

private:
    struct State;
    std::unique_ptr<State> state_;
};

[[nodiscard]] Sha256::Digest sha256_of(std::string_view text);
/// 64 small hexadecimal digits, as sha256sum prints them.
[[nodiscard]] std::string hexadecimal(const Sha256::Digest& digest);

}  // namespace taktwerk::runtime
