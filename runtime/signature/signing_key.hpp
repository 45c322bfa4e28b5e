#pragma once
// Ed25519 keys and signatures (RFC 8032). A key is a PEM file in the form of RFC 8410, which `openssl genpkey -algorithm ed25519` makes as well;
// a signature is its 64 bytes, which `openssl pkeyutl -verify -rawin` checks as well. Not real-time.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace taktwerk::runtime {

inline constexpr std::size_t signature_size = 64;

/// What may be shown to everybody.
class PublicKey {
public:
    using Bytes = std::array<unsigned char, 32>;
    explicit PublicKey(const Bytes& bytes) : bytes_(bytes) {}
    /// "-----BEGIN PUBLIC KEY-----" and so on; blanks and lines around it do no harm. `file` is for messages.
    /// Errors: key.not_public (another kind of key, a secret one, or none at all).
    [[nodiscard]] static Result<PublicKey> of_pem(std::string_view text, const std::string& file);
    [[nodiscard]] std::string pem() const;
    /// Whether the holder of its secret half has signed exactly this text. Any bytes may come as `signature`.
    [[nodiscard]] bool has_signed(std::string_view text, std::string_view signature) const;
    /// 16 hexadecimal digits of its SHA-256: by which people compare keys.
    [[nodiscard]] std::string fingerprint() const;
    friend bool operator==(const PublicKey&, const PublicKey&) = default;

private:
    Bytes bytes_;
};

/// What its owner keeps. Its bytes are wiped when it goes.
class SecretKey {
public:
    /// A new one. Errors: key.random, where the system gives no random numbers.
    [[nodiscard]] static Result<SecretKey> make();
    /// "-----BEGIN PRIVATE KEY-----". Errors: key.not_secret (another kind of key, an encrypted or a public one, or none at all).
    [[nodiscard]] static Result<SecretKey> of_pem(std::string_view text, const std::string& file);
    ~SecretKey();
    SecretKey(SecretKey&&) noexcept;
    SecretKey& operator=(SecretKey&&) = delete;
    SecretKey(const SecretKey&) = delete;
    SecretKey& operator=(const SecretKey&) = delete;

    [[nodiscard]] std::string pem() const;
    [[nodiscard]] PublicKey public_half() const;
    /// 64 bytes, the same for the same text each time.
    [[nodiscard]] std::string sign(std::string_view text) const;

private:
    using Seed = std::array<unsigned char, 32>;
    explicit SecretKey(const Seed& seed) : seed_(seed) {}
    Seed seed_;
};

}  // namespace taktwerk::runtime
