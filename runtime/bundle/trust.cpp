#include "runtime/bundle/trust.hpp"

#include <sys/stat.h>

#include <algorithm>

#include <fmt/format.h>

#include "runtime/bundle/durable.hpp"

namespace taktwerk::runtime {

namespace {

constexpr std::size_t longest_key_file = 4096;  ///< bytes; a key has about 120

/// Who may write there may trust whom he likes. A group of one's own (its number is the user's, as Debian makes users) is nobody else.
bool others_may_write(const std::filesystem::path& path) {
    struct stat info {};
    if (::stat(path.c_str(), &info) != 0) return false;
    return (info.st_mode & S_IWOTH) != 0 || ((info.st_mode & S_IWGRP) != 0 && info.st_gid != info.st_uid);
}

Error open_to_others(const std::filesystem::path& path) {
    return {"trust.open", path.string(), "others than its owner may write it, and so decide whose bundles this computer takes",
            fmt::format("look whether it is as you left it, then `chmod go-w {}`", path.string())};
}

std::string names_of(const std::vector<TrustedKey>& keys) {
    std::string out;
    for (const auto& key : keys) out += fmt::format("{}{} ({})", out.empty() ? "" : ", ", key.name, key.key.fingerprint());
    return out;
}

}  // namespace

std::string words_of(const Signer& signer) {
    switch (signer.kind) {
        case Signer::Kind::trusted: return fmt::format("signed by {} ({})", signer.name, signer.fingerprint);
        case Signer::Kind::unjudged: return "signed, but no key is trusted here";
        case Signer::Kind::unsigned_: break;
    }
    return "not signed";
}

Result<Trust> Trust::read(const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    std::vector<TrustedKey> keys;
    std::error_code failed;
    if (const auto there = fs::symlink_status(folder, failed); there.type() == fs::file_type::not_found) return Trust({}, folder.string());
    if (others_may_write(folder)) return open_to_others(folder);
    fs::directory_iterator entry(folder, failed);
    for (const fs::directory_iterator end; !failed && entry != end; entry.increment(failed)) {
        const auto& path = entry->path();
        if (path.extension() != public_key_ending) {
            const auto text = read_small_file(path, longest_key_file);
            if (text && text->find("PUBLIC KEY-----") != std::string::npos && path.string().back() != '~')
                return Error{"trust.unreadable", path.string(),
                             "it holds a public key, and would be passed over: its name does not end in .pub",
                             "call it NAME.pub, or take it away"};
            continue;
        }
        if (others_may_write(path)) return open_to_others(path);
        const auto text = read_small_file(path, longest_key_file);
        if (!text)
            return Error{"trust.unreadable", path.string(), text.error().what, "let whoever installs bundles read it, or take it away"};
        auto key = PublicKey::of_pem(*text, path.string());
        if (!key) return key.error();
        keys.push_back({path.stem().string(), *key});
    }
    if (failed)
        return Error{"trust.unreadable", folder.string(),
                     fmt::format("the folder of the trusted keys cannot be read: {}", failed.message()),
                     "let whoever installs bundles read it"};
    std::sort(keys.begin(), keys.end(), [](const TrustedKey& a, const TrustedKey& b) { return a.name < b.name; });
    return Trust(std::move(keys), folder.string());
}

Result<Signer> Trust::judge(std::string_view manifest, const std::optional<std::string>& signature, const std::string& subject) const {
    if (keys_.empty()) return Signer{signature ? Signer::Kind::unjudged : Signer::Kind::unsigned_, {}, {}};
    if (!signature)
        return Error{"bundle.unsigned", subject, fmt::format("nobody has signed it, and this computer trusts only {}", names_of(keys_)),
                     "make it with `taktwerk bundle make --key FILE`"};
    for (const auto& key : keys_)
        if (key.key.has_signed(manifest, *signature)) return Signer{Signer::Kind::trusted, key.name, key.key.fingerprint()};
    return Error{
        "bundle.foreign", subject,
        fmt::format("none of the trusted keys has signed what it says: {}; another key has, or it was changed since", names_of(keys_)),
        fmt::format("ask whoever sent it; if that key shall count, put its .pub into {}", folder_)};
}

}  // namespace taktwerk::runtime
