#include "runtime/tasks/program_library.hpp"

#include <dlfcn.h>
#include <sys/stat.h>

#include <exception>

#include <fmt/format.h>

#include "programs/api/abi.hpp"
#include "runtime/tasks/borrowed_rights.hpp"
#include "runtime/tasks/shared_object_check.hpp"

namespace taktwerk::runtime {

namespace {

Result<void> check_entry(const ProgramEntry* entry, const std::string& subject) {
    if (!entry || entry->magic != program_magic || entry->entry_size != sizeof(ProgramEntry))
        return Error{"program.foreign", subject, "its entry is not one of a Taktwerk program of this kind",
                     "build it against this SDK and put TAKTWERK_PROGRAM(YourClass) into one source file"};
    if (entry->abi_hash != abi_hash())
        return Error{"program.abi", subject,
                     fmt::format("it was built with SDK {} (ABI {:016x}), this runtime is {} (ABI {:016x})",
                                 entry->sdk_version ? entry->sdk_version : "unknown", entry->abi_hash, sdk_version, abi_hash()),
                     "rebuild the program with the SDK of this runtime"};
    if (!entry->name || !entry->create || !entry->destroy)
        return Error{"program.foreign", subject, "its entry is incomplete: it lacks the name, create or destroy",
                     "let TAKTWERK_PROGRAM(YourClass) write it"};
    return {};
}

}  // namespace

Result<ProgramLibrary> ProgramLibrary::open(const std::string& path) {
    struct stat info {};
    if (::stat(path.c_str(), &info) != 0)
        return Error{"program.missing", path, "there is no such file", "build the program, or correct `library:`"};
    if (!S_ISREG(info.st_mode)) return Error{"program.missing", path, "it is not a file", "correct `library:`"};
    if (auto ok = check_shared_object(path); !ok) return ok.error();
    if (rights_are_borrowed() && !belongs_to_root(path))
        return Error{
            "program.borrowed_rights", path,
            "this process has rights from its own file (setcap) that its caller has not, and others than root may write the program",
            "take the rights from the file (setcap -r) and run the machine as a service with them (docs/bus.md)"};
    // dlopen searches names without a slash in system folders: a program is a file, not a library name.
    const std::string file = path.find('/') == std::string::npos ? "./" + path : path;
    void* raw = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!raw) {
        const char* why = ::dlerror();
        return Error{"program.not_loadable", path, fmt::format("it cannot be loaded: {}", why ? why : "unknown reason"),
                     "build it as a shared object for this machine, linking only the SDK"};
    }
    std::shared_ptr<void> handle{raw, [](void* p) { ::dlclose(p); }};
    using Entry = const ProgramEntry* (*)();
    auto function = reinterpret_cast<Entry>(::dlsym(raw, program_entry_symbol));
    if (!function)
        return Error{"program.no_entry", path, fmt::format("it exports no `{}`: it is some other shared object", program_entry_symbol),
                     "put TAKTWERK_PROGRAM(YourClass) into one source file of the program"};
    const ProgramEntry* entry = function();
    if (auto ok = check_entry(entry, path); !ok) return ok.error();
    return ProgramLibrary{std::move(handle), entry};
}

std::uint64_t ProgramLibrary::expected_abi() noexcept { return abi_hash(); }

Result<ProgramLibrary> ProgramLibrary::linked(const ProgramEntry* entry) {
    if (auto ok = check_entry(entry, "linked program"); !ok) return ok.error();
    return ProgramLibrary{nullptr, entry};
}

Result<ProgramLibrary::Instance> ProgramLibrary::create() const {
    const auto failed = [&](std::string what) {
        return Error{"program.constructor", entry_->name, std::move(what), "mend the program: a constructor only sets members"};
    };
    try {
        Instance instance{entry_->create(), Deleter{entry_->destroy}};
        if (!instance) return failed("it gave no program");
        return instance;
    } catch (const std::exception& e) {
        return failed(fmt::format("its constructor threw: {}", e.what()));
    } catch (...) {
        return failed("its constructor threw something that is no std::exception");
    }
}

}  // namespace taktwerk::runtime
