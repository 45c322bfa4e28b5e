// taktwerk bundle keygen: a key to sign bundles with, and its public half for the computers that shall take them.

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "apps/bundle/commands.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "runtime/bundle/durable.hpp"
#include "runtime/bundle/manifest.hpp"
#include "runtime/signature/signing_key.hpp"

namespace taktwerk::apps {
namespace {

using namespace runtime;

struct KeygenOptions {
    std::string name, folder = ".";
};

/// For its owner alone, and never over another one: a lost key is lost for good.
Result<void> write_key(const std::string& path, const std::string& text, unsigned mode) {
    const auto failed = [&] {
        const bool there = errno == EEXIST;
        return Error{"key.not_written", path,
                     there ? std::string("there is such a file already") : fmt::format("it cannot be written: {}", std::strerror(errno)),
                     there ? "take another name: who has lost a key cannot sign with it any more" : "name another folder with -o"};
    };
    const OwnedFd fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, mode));
    if (!fd || ::write(fd.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size()) || ::fsync(fd.get()) != 0) return failed();
    return {};
}

int keygen(const KeygenOptions& options) {
    if (!is_bundle_name(options.name)) {
        print_error(
            {"usage.key_name", options.name, "this is no name for a key", "use up to 40 letters, digits, `_` and `-`, a letter first"});
        return exit_usage;
    }
    const auto key = SecretKey::make();
    if (!key) return fail_bundle(key.error());
    const auto path = (std::filesystem::path(options.folder) / options.name).lexically_normal().string();
    if (auto ok = write_key(path + ".key", key->pem(), 0600); !ok) return fail_bundle(ok.error());
    if (auto ok = write_key(path + public_key_ending, key->public_half().pem(), 0644); !ok) return fail_bundle(ok.error());
    fmt::print("{0}.key: sign with it (taktwerk bundle make --key {0}.key), keep it, and give it to nobody\n", path);
    fmt::print("{}{}: copy it into {} of each computer that shall take your bundles; its fingerprint is {}\n", path, public_key_ending,
               usual_trust_folder, key->public_half().fingerprint());
    return exit_ok;
}

}  // namespace

void add_bundle_keygen(CLI::App& bundle, Action& action) {
    auto options = std::make_shared<KeygenOptions>();
    auto* sub = bundle.add_subcommand("keygen", "make a key to sign bundles with");
    sub->add_option("NAME", options->name, "NAME.key and NAME.pub are written")->required();
    sub->add_option("-o,--output", options->folder, "into this folder")->capture_default_str();
    sub->callback([&action, options] { action = [options] { return keygen(*options); }; });
}

}  // namespace taktwerk::apps
