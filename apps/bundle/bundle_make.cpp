// taktwerk bundle make: checks a machine and packs everything that its file names.

#include <unistd.h>

#include <charconv>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

#include <fmt/format.h>

#include "apps/bundle/commands.hpp"
#include "apps/bundle/packed_machine.hpp"
#include "apps/machine/checked_machine.hpp"
#include "apps/machine/load.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "runtime/bundle/durable.hpp"
#include "runtime/bundle/target.hpp"
#include "runtime/tasks/program_library.hpp"
#include "runtime/tasks/shared_object_check.hpp"

namespace taktwerk::apps {
namespace {

namespace fs = std::filesystem;
using namespace runtime;

struct MakeOptions {
    std::string file, out, key, version;
};

constexpr std::size_t longest_key_file = 4096;

/// Now, or what $SOURCE_DATE_EPOCH says (https://reproducible-builds.org/specs/source-date-epoch/): then the same files make the same bundle.
std::int64_t creation_time() {
    if (const char* given = std::getenv("SOURCE_DATE_EPOCH")) {
        const std::string_view text = given;
        std::int64_t seconds = 0;
        if (std::from_chars(text.data(), text.data() + text.size(), seconds).ec == std::errc{} && seconds >= 0) return seconds;
    }
    return std::chrono::system_clock::now().time_since_epoch() / std::chrono::seconds{1};
}

/// "20261126-051200", of "2026-11-26T05:12:00Z".
std::string version_of_time(std::int64_t seconds) {
    auto text = utc_text(seconds);
    std::erase_if(text, [](char c) { return c == '-' || c == ':' || c == 'Z'; });
    text[text.find('T')] = '-';
    return text;
}

Result<std::vector<BundledProgram>> programs_of(const CheckedMachine& machine, const PackedMachine& packed) {
    std::vector<BundledProgram> out;
    for (const auto& program : machine.config.programs) {
        if (program.library.empty()) continue;
        auto library = ProgramLibrary::open(program.library);
        if (!library) return library.error();
        const auto file = std::find_if(machine.files.begin(), machine.files.end(), [&](const config::UsedFile& used) {
            return used.kind == config::UsedFile::Kind::program && used.path == program.library;
        });
        if (file == machine.files.end()) continue;
        const auto& entry = library->entry();
        out.push_back({program.name, packed.place_of(file->written), entry.abi_hash, this_host().interface_version,
                       entry.sdk_version != nullptr ? entry.sdk_version : "unknown", build_id_of(program.library)});
    }
    return out;
}

/// Unpacked somewhere else, the machine must load, and from nothing but what was unpacked.
Result<void> stands_alone(const std::string& text, const Manifest& manifest) {
    class Memory : public ByteSource {
    public:
        explicit Memory(const std::string& text) : text_(text) {}
        [[nodiscard]] std::uint64_t size() const override { return text_.size(); }
        [[nodiscard]] Result<void> read(std::uint64_t offset, std::span<std::byte> into) const override {
            const auto from = std::as_bytes(std::span(text_.data(), text_.size())).subspan(offset, into.size());
            std::copy(from.begin(), from.end(), into.begin());
            return {};
        }

    private:
        const std::string& text_;
    };
    auto aside = AsideFolder::make(fs::temp_directory_path());
    if (!aside) return aside.error();
    auto bundle = BundleFile::read(std::make_unique<Memory>(text), "bundle", Trust({}));
    if (!bundle) return bundle.error();
    if (auto ok = bundle->unpack(aside->path()); !ok) return ok;
    auto unpacked = read_unpacked(aside->path());
    if (!unpacked) return unpacked.error();
    auto loaded = read_machine(unpacked->machine_file().string(), false);
    if (auto* errors = std::get_if<std::vector<Error>>(&loaded)) {
        auto error = errors->front();
        error.what = "the machine does not load from its bundle: " + error.what;
        return error;
    }
    for (const auto& file : std::get<LoadedFile>(loaded).files)
        if (!file.path.starts_with(aside->path().string() + "/"))
            return Error{"bundle.outside", manifest.machine_file,
                         fmt::format("from its bundle the machine would take '{}' of this computer", file.path),
                         "give that file a name that no other one has"};
    return {};
}

Result<std::optional<SecretKey>> key_of(const MakeOptions& options) {
    if (options.key.empty()) return std::optional<SecretKey>{};
    const auto text = read_small_file(options.key, longest_key_file);
    if (!text) return text.error();
    auto key = SecretKey::of_pem(*text, options.key);
    if (!key) return key.error();
    return std::optional(std::move(key).value());
}

/// Only a bundle is written over: not the machine file, not the key.
std::optional<Error> in_the_way(const std::string& out) {
    std::error_code failed;
    const auto there = fs::status(out, failed);
    if (!fs::exists(there)) return std::nullopt;
    constexpr std::string_view begin{"manifest.json\0", 14};
    std::string first(begin.size(), '\0');
    if (fs::is_regular_file(there)) std::ifstream(out, std::ios::binary).read(first.data(), static_cast<std::streamsize>(first.size()));
    if (first == begin) return std::nullopt;
    return Error{"bundle.in_the_way", out,
                 fs::is_directory(there) ? "there is such a folder" : "there is something else of this name, which is no bundle",
                 "take another name with -o, or remove it first"};
}

int make(const MakeOptions& options) {
    // First what is quick to refuse.
    if (!options.version.empty() && !is_bundle_version(options.version)) {
        print_error({"usage.version", options.version, "this is no version", "use up to 40 letters, digits and `._+-`, such as 1.4.0"});
        return exit_usage;
    }
    const auto key = key_of(options);
    if (!key) return fail_bundle(key.error());
    auto result = check_machine(options.file);
    if (const auto* errors = std::get_if<std::vector<Error>>(&result)) {
        print_errors(*errors);
        return exit_bad_file;
    }
    const auto& machine = std::get<CheckedMachine>(result);
    for (const auto& warning : machine.warnings) print_warning(warning);
    for (const auto& remark : machine.remarks) print_warning(remark);
    auto packed = pack(options.file, machine.files);
    if (!packed) return fail_bundle(packed.error());
    auto programs = programs_of(machine, *packed);
    if (!programs) return fail_bundle(programs.error());

    const auto host = this_host();
    Manifest manifest;
    manifest.name = machine.config.name;
    manifest.created = creation_time();
    manifest.version = options.version.empty() ? version_of_time(manifest.created) : options.version;
    manifest.minimum_runtime = host.version;
    manifest.target = host.target;
    manifest.machine_file = packed->machine_file;
    manifest.programs = std::move(programs).value();
    const auto text = bundle_text(manifest, packed->files, *key ? &**key : nullptr);
    if (!text) return fail_bundle(text.error());
    if (auto ok = stands_alone(*text, manifest); !ok) return fail_bundle(ok.error());
    const auto out = options.out.empty() ? fmt::format("{}-{}.twb", manifest.name, manifest.version) : options.out;
    if (const auto other = in_the_way(out)) return fail_bundle(*other);
    if (auto ok = replace_file(out, *text); !ok) return fail_bundle(ok.error());

    fmt::print("{}: machine '{}' {} for {}, {}, {}\n", out, manifest.name, manifest.version, manifest.target,
               count_text(packed->files.size(), "file"), size_text(text->size()));
    for (const auto& file : packed->files) fmt::print("  {:<9} {}\n", file.kind, file.path);
    if (*key) fmt::print("Signed with {}.\n", (*key)->public_half().fingerprint());
    else fmt::print("Not signed: a computer that trusts a key does not take it (`--key FILE`, `taktwerk bundle keygen`).\n");
    fmt::print("On the machine's computer: taktwerk bundle install {}\n", fs::path(out).filename().string());
    return exit_ok;
}

}  // namespace

void add_bundle_make(CLI::App& bundle, Action& action) {
    auto options = std::make_shared<MakeOptions>();
    auto* sub = bundle.add_subcommand("make", "check a machine, and pack what its file names");
    sub->add_option("FILE", options->file, "machine file")->required();
    sub->add_option("-o,--output", options->out, "the bundle; default: MACHINE-VERSION.twb");
    sub->add_option("--version", options->version, "of the machine, such as 1.4.0; default: the time, such as 20261126-051200");
    sub->add_option("--key", options->key, "sign it with this secret key");
    sub->callback([&action, options] { action = [options] { return make(*options); }; });
}

}  // namespace taktwerk::apps
