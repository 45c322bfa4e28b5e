#pragma once
// Loading a program from a shared object, with an answer for everything that can be wrong with it. Not real-time.

#include <cstdint>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "programs/api/program_entry.hpp"

namespace taktwerk::runtime {

/// Keeps the library loaded while it lives.
class ProgramLibrary {
public:
    /// Static constructors of the library run here. Errors (code): program.missing (no such file, or no file), program.not_loadable
    /// (no shared object, for another processor, cut short, unresolved symbols), program.no_entry, program.foreign (another
    /// magic or an incomplete entry), program.abi (built against another SDK).
    static Result<ProgramLibrary> open(const std::string& path);
    /// A program linked into this executable.
    static Result<ProgramLibrary> linked(const ProgramEntry* entry);
    /// What a program must have been built against (programs/api/abi.hpp).
    [[nodiscard]] static std::uint64_t expected_abi() noexcept;

    [[nodiscard]] const ProgramEntry& entry() const noexcept { return *entry_; }

    struct Deleter {
        void (*destroy)(Program*) = nullptr;
        void operator()(Program* program) const noexcept {
            if (program && destroy) destroy(program);
        }
    };
    using Instance = std::unique_ptr<Program, Deleter>;
    /// The constructor of the program runs here; an exception of it becomes the error program.constructor. Never null.
    [[nodiscard]] Result<Instance> create() const;

private:
    ProgramLibrary(std::shared_ptr<void> handle, const ProgramEntry* entry) : handle_(std::move(handle)), entry_(entry) {}
    std::shared_ptr<void> handle_;
    const ProgramEntry* entry_;
};

}  // namespace taktwerk::runtime
