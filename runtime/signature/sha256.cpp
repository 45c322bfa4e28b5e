#include "runtime/signature/sha256.hpp"

#include <sodium.h>

namespace taktwerk::runtime {

static_assert(Sha256::size == crypto_hash_sha256_BYTES);

struct Sha256::State {
    crypto_hash_sha256_state of_library;
};

Sha256::Sha256() : state_(std::make_unique<State>()) { crypto_hash_sha256_init(&state_->of_library); }
Sha256::~Sha256() = default;

void Sha256::add(std::span<const std::byte> part) {
    crypto_hash_sha256_update(&state_->of_library, reinterpret_cast<const unsigned char*>(part.data()), part.size());
}

Sha256::Digest Sha256::finish() {
    Digest digest{};
    crypto_hash_sha256_final(&state_->of_library, reinterpret_cast<unsigned char*>(digest.data()));
    return digest;
}

Sha256::Digest sha256_of(std::string_view text) {
    Sha256 sum;
    sum.add(std::as_bytes(std::span(text.data(), text.size())));
    return sum.finish();
}

std::string hexadecimal(const Sha256::Digest& digest) {
    std::string text(2 * digest.size() + 1, '\0');
    sodium_bin2hex(text.data(), text.size(), reinterpret_cast<const unsigned char*>(digest.data()), digest.size());
    text.pop_back();
    return text;
}

}  // namespace taktwerk::runtime
