#pragma once
// Goes with a load: where in the file we are, what was wrong so far, and what later fields need of earlier ones.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "config/reading/document.hpp"
#include "core/result.hpp"
#include "core/time.hpp"

namespace taktwerk::config {

class Reader {
public:
    explicit Reader(std::string file) : file_(std::move(file)) {}

    void problem(Position at, std::string code, std::string what, std::string remedy);
    /// About the place `path` ("axes.x.slave"), after reading.
    void problem_in(std::string_view path, std::string code, std::string what, std::string remedy);
    [[nodiscard]] const std::string& file() const noexcept { return file_; }
    [[nodiscard]] const std::string& path() const noexcept { return path_; }  ///< "axes.x.limits"
    [[nodiscard]] std::vector<Error>& errors() noexcept { return errors_; }

    /// The position of "axes.x.limits.velocity", or of the nearest section around it that stands in the file.
    [[nodiscard]] Position find(std::string_view path) const;
    /// Whether the file has this key.
    [[nodiscard]] bool has(std::string_view path) const { return positions_.contains(path); }
    /// Another name for a place, as the floors' checks call it.
    void also_known_as(std::string path, Position at) { positions_.emplace(std::move(path), at); }
    /// Complaints about this place would only repeat a problem reported elsewhere.
    void mark_bad(std::string path) { bad_paths_.push_back(std::move(path)); }
    /// Whether a problem was reported in this place, in it or around it: then further complaints about it are noise.
    [[nodiscard]] bool already_bad(std::string_view path) const;

    /// Enters a key; leaves it at the end of the scope.
    class Scope {
    public:
        Scope(Reader& reader, std::string_view key, Position at);
        ~Scope() { reader_.path_.resize(length_); }
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

    private:
        Reader& reader_;
        std::size_t length_;
    };

    /// A section and its keys, while it is read.
    class Section {
    public:
        Section(Reader& reader, const std::vector<std::string>& keys) : reader_(reader) {
            reader.sections_.push_back({reader.path_, &keys});
        }
        ~Section() { reader_.sections_.pop_back(); }
        Section(const Section&) = delete;
        Section& operator=(const Section&) = delete;

    private:
        Reader& reader_;
    };
    /// The nearest section around this one that has such a key, as its path; nullptr: none. Empty: the file itself.
    [[nodiscard]] const std::string* outer_section_with(std::string_view key) const;

    std::string axis_unit = "mm";                                   ///< of the axis being read, and of a cam's slave
    std::string master_unit;                                        ///< of the master of the cam being read
    std::map<std::string, std::string, std::less<>> units_of_axes;  ///< once read
    Duration cycle{};                                               ///< of the machine, once read

private:
    struct OpenSection {
        std::string path;
        const std::vector<std::string>* keys;
    };
    std::string file_, path_;
    std::vector<OpenSection> sections_;
    std::vector<Error> errors_;
    std::vector<std::string> bad_paths_;
    std::map<std::string, Position, std::less<>> positions_;
};

}  // namespace taktwerk::config
