#include "runtime/bundle/active_bundle.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace taktwerk::runtime {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kept_activations = 10;  ///< the active one and those to go back to
constexpr unsigned most_starts = 1'000'000;

fs::path activations(const BundleStore& store, const std::string& machine) { return store.folder(machine) / "activations"; }
fs::path activation_folder(const BundleStore& store, const std::string& machine, std::uint64_t number) {
    return activations(store, machine) / std::to_string(number);
}
fs::path current_link(const BundleStore& store, const std::string& machine) { return store.folder(machine) / "current"; }
std::string current_text(std::uint64_t number) { return fmt::format("activations/{}", number); }

std::optional<std::uint64_t> number_in(std::string_view text) {
    std::uint64_t number = 0;
    const auto end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc{} || at != end || number == 0) return std::nullopt;
    return number;
}

unsigned starts_in(const fs::path& activation) {
    const auto text = read_small_file(activation / "starts", 64);
    if (!text) return 0;
    return static_cast<unsigned>(std::min<std::uint64_t>(number_in(*text).value_or(0), most_starts));
}

bool has_worked(const fs::path& activation) {
    std::error_code failed;
    return fs::exists(activation / "worked", failed);
}

std::optional<Activation> read_activation(const BundleStore& store, const std::string& machine, std::uint64_t number) {
    const auto folder = activation_folder(store, machine, number);
    const auto bundle = link_text(folder / "bundle");
    if (!bundle) return std::nullopt;
    Activation out{number, fs::path(*bundle).filename().string(), starts_in(folder), has_worked(folder)};
    std::error_code failed;
    if (!is_bundle_version(out.version) || !fs::is_directory(store.version_folder(machine, out.version), failed)) return std::nullopt;
    return out;
}

std::optional<std::uint64_t> before(const BundleStore& store, const std::string& machine, std::uint64_t number) {
    const auto link = link_text(activation_folder(store, machine, number) / "before");
    return link ? number_in(fs::path(*link).filename().string()) : std::nullopt;
}

std::vector<std::uint64_t> numbers_there(const BundleStore& store, const std::string& machine) {
    std::vector<std::uint64_t> numbers;
    std::error_code failed;
    for (fs::directory_iterator entry(activations(store, machine), failed), end; !failed && entry != end; entry.increment(failed))
        if (const auto number = number_in(entry->path().filename().string())) numbers.push_back(*number);
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

/// Those that nobody can go back to any more.
void prune(const BundleStore& store, const std::string& machine) {
    auto chain = activations_of(store, machine);
    if (chain.size() > kept_activations) chain.resize(kept_activations);
    std::error_code ignored;
    for (const auto number : numbers_there(store, machine))
        if (std::none_of(chain.begin(), chain.end(), [&](const Activation& one) { return one.number == number; }))
            fs::remove_all(activation_folder(store, machine, number), ignored);
}

Error none_active(const BundleStore& store, const std::string& machine) {
    return {"bundle.none_active", machine,
            fmt::format("no version of it is active (installed: {})", fmt::join(store.versions(machine), ", ")),
            fmt::format("`taktwerk bundle activate {} VERSION`", machine)};
}

/// Its files are whole and this computer can run it.
Result<UnpackedBundle> runnable(const BundleStore& store, const std::string& machine, const std::string& version, const Host& host) {
    auto bundle = store.find(machine, version);
    if (!bundle) return bundle;
    if (auto ok = fits(bundle->manifest, host, fmt::format("{} {}", machine, version)); !ok) return ok.error();
    if (auto ok = verify(*bundle); !ok) return ok.error();
    return bundle;
}

/// In an activation before: what does not come up then is the machine and not this version.
bool version_has_worked(const BundleStore& store, const std::string& machine, const std::vector<std::uint64_t>& numbers,
                        const std::string& version) {
    return std::any_of(numbers.begin(), numbers.end(), [&](std::uint64_t number) {
        const auto one = read_activation(store, machine, number);
        return one && one->version == version && one->worked;
    });
}

Result<void> put_activation(const BundleStore& store, const std::string& machine, std::uint64_t number, const std::string& version,
                            std::uint64_t before, bool worked) {
    auto aside = AsideFolder::make(store.bundles());
    if (!aside) return aside.error();
    if (auto ok = make_link(aside->path() / "bundle", fmt::format("../../versions/{}", version)); !ok) return ok;
    if (before != 0)
        if (auto ok = make_link(aside->path() / "before", fmt::format("../{}", before)); !ok) return ok;
    if (worked)
        if (auto ok = write_new_file(aside->path() / "worked", ""); !ok) return ok;
    if (auto ok = sync_folder(aside->path()); !ok) return ok;
    if (auto ok = make_folders(activations(store, machine)); !ok) return ok;
    return move_into_place(aside->path(), activation_folder(store, machine, number));
}

std::string version_of(const std::vector<Activation>& chain, std::size_t place) {
    return place < chain.size() ? chain[place].version : std::string{};
}

}  // namespace

std::vector<Activation> activations_of(const BundleStore& store, const std::string& machine) {
    std::vector<Activation> chain;
    const auto link = link_text(current_link(store, machine));
    auto number = link ? number_in(fs::path(*link).filename().string()) : std::nullopt;
    // `before` is always a lower number, whatever stands in the folder: the chain has an end.
    while (number) {
        auto one = read_activation(store, machine, *number);
        if (!one && chain.empty()) return {};
        if (one) chain.push_back(std::move(*one));
        const auto next = before(store, machine, *number);
        number = next && *next < *number ? next : std::nullopt;
    }
    return chain;
}

Result<Switched> activate(const BundleStore& store, const std::string& machine, const std::string& version, const Trust& trust,
                          const Host& host, const Deed& deed) {
    const auto locked = store.lock();
    if (!locked) return locked.error();
    const auto bundle = runnable(store, machine, version, host);
    if (!bundle) return bundle.error();
    if (auto ok = trust.judge(bundle->manifest_text, bundle->signature, fmt::format("{} {}", machine, version)); !ok) return ok.error();
    const auto chain = activations_of(store, machine);
    const auto numbers = numbers_there(store, machine);
    const auto number = numbers.empty() ? 1 : numbers.back() + 1;
    // The same version again: what lies before it stays the way back.
    const std::size_t behind = !chain.empty() && chain.front().version == version ? 1 : 0;
    const auto back = behind < chain.size() ? chain[behind].number : 0;
    const bool worked = version_has_worked(store, machine, numbers, version);
    if (auto ok = put_activation(store, machine, number, version, back, worked); !ok) return ok.error();
    Switched out{version_of(chain, 0), version, version_of(chain, behind)};
    if (auto ok = write_audit(store.folder(machine), deed, {"activate", out.from, out.to}); !ok) return ok.error();
    if (auto ok = replace_link(current_link(store, machine), current_text(number)); !ok) return ok.error();
    prune(store, machine);
    return out;
}

Result<Switched> roll_back(const BundleStore& store, const std::string& machine, const Host& host, const Deed& deed) {
    const auto locked = store.lock();
    if (!locked) return locked.error();
    if (const auto known = store.machines(); std::find(known.begin(), known.end(), machine) == known.end())
        return store.find(machine, "").error();
    const auto chain = activations_of(store, machine);
    if (chain.empty()) return none_active(store, machine);
    if (chain.size() == 1)
        return Error{"bundle.no_way_back", machine, fmt::format("no other version was active before {}", chain.front().version),
                     fmt::format("`taktwerk bundle activate {} VERSION` takes any that is installed: {}", machine,
                                 fmt::join(store.versions(machine), ", "))};
    if (const auto bundle = runnable(store, machine, chain[1].version, host); !bundle) return bundle.error();
    Switched out{chain.front().version, chain[1].version, version_of(chain, 2)};
    // The way back is open whatever the disk is like; the audit may be the poorer.
    if (auto ok = write_audit(store.folder(machine), deed, {"roll back", out.from, out.to}); !ok) out.remarks.push_back(ok.error());
    if (auto ok = replace_link(current_link(store, machine), current_text(chain[1].number)); !ok) return ok.error();
    return out;
}

Result<BundleStart> begin_start(const BundleStore& store, const std::string& machine, unsigned tries, const Host& host, const Deed& deed) {
    if (const auto known = store.machines(); std::find(known.begin(), known.end(), machine) == known.end())
        return store.find(machine, "").error();
    const auto locked = store.lock();
    if (!locked) return locked.error();
    // It would fail for that reason alone, be counted, and in the end take the version away under a machine that runs.
    for (const auto& version : store.versions(machine))
        if (in_use(store.version_folder(machine, version)))
            return Error{"bundle.machine_runs", machine, fmt::format("it runs already, from version {}", version),
                         "stop it first: `taktwerk shutdown`"};
    const auto chain = activations_of(store, machine);
    if (chain.empty()) return none_active(store, machine);
    std::optional<UnpackedBundle> chosen;
    std::optional<Error> first_trouble;
    std::size_t place = 0;
    std::string why;
    for (; place < chain.size(); ++place) {
        const auto& one = chain[place];
        auto bundle = runnable(store, machine, one.version, host);
        if (!bundle) {
            if (!first_trouble) first_trouble = bundle.error();
            if (place == 0) why = bundle.error().text();
        } else if (!one.worked && one.failed_starts >= tries) {
            if (place == 0) why = fmt::format("{} starts in a row did not reach operation", one.failed_starts);
            if (!chosen) chosen = std::move(bundle).value();  // better than none, where all others are no better
            continue;
        } else {
            chosen = std::move(bundle).value();
            break;
        }
    }
    if (!chosen) return *first_trouble;
    BundleStart out{std::move(*chosen), store.state(machine), {}, {}, OwnedFd{}, false};
    const auto& version = out.bundle.manifest.version;
    if (place == chain.size()) {
        // None is any better: the nearest one that is whole, once more.
        place = static_cast<std::size_t>(
            std::find_if(chain.begin(), chain.end(), [&](const Activation& one) { return one.version == version; }) - chain.begin());
        out.remarks.push_back({"bundle.no_way_back", fmt::format("{} {}", machine, version),
                               fmt::format("{} starts in a row did not reach operation, and there is no version before it that would",
                                           chain[place].failed_starts),
                               "look at the alarms and at the log; `taktwerk bundle activate` takes another version"});
    }
    out.fell_back = place > 0;
    if (out.fell_back) {
        out.remarks.push_back(
            {"bundle.fell_back", machine, fmt::format("version {} is left and {} is active again: {}", chain.front().version, version, why),
             fmt::format("find out what is wrong with {}; `taktwerk bundle activate` takes it again", chain.front().version)});
        if (auto ok = write_audit(store.folder(machine), deed, {"fall back", chain.front().version, version, why}); !ok)
            out.remarks.push_back(ok.error());
        if (auto ok = replace_link(current_link(store, machine), current_text(chain[place].number)); !ok) out.remarks.push_back(ok.error());
    }
    out.activation = activation_folder(store, machine, chain[place].number);
    if (!chain[place].worked)
        if (auto ok = replace_file(out.activation / "starts", std::to_string(chain[place].failed_starts + 1)); !ok)
            out.remarks.push_back(ok.error());
    out.held = hold_folder(out.bundle.folder);
    return out;
}

Result<void> start_succeeded(const fs::path& activation) {
    if (has_worked(activation)) return {};
    return replace_file(activation / "worked", "");
}

void start_was_ended(const fs::path& activation) {
    if (has_worked(activation)) return;
    // Where it cannot be written it counts: one start fewer until the way back.
    if (const auto starts = starts_in(activation); starts > 0) (void)replace_file(activation / "starts", std::to_string(starts - 1)).ok();
}

}  // namespace taktwerk::runtime
