#include "apps/hmi/users.hpp"

#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <iostream>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "hmi_bridge/web/account/password.hpp"
#include "hmi_bridge/web/account/users.hpp"

namespace taktwerk::apps {
namespace {

using hmi::web::Role;
using hmi::web::User;
using hmi::web::Users;

struct UserOptions {
    std::string file, name, role;
};

int told(const Error& error, int code = exit_bad_file) {
    print_error(error);
    return code;
}

/// What is typed does not appear, whatever happens in between.
class QuietTerminal {
public:
    QuietTerminal() {
        is_one_ = ::tcgetattr(STDIN_FILENO, &before_) == 0;
        if (!is_one_) return;
        auto quiet = before_;
        quiet.c_lflag &= ~static_cast<tcflag_t>(ECHO);
        ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &quiet);
    }
    ~QuietTerminal() {
        if (is_one_) ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_);
    }
    QuietTerminal(const QuietTerminal&) = delete;
    QuietTerminal& operator=(const QuietTerminal&) = delete;

private:
    bool is_one_ = false;
    termios before_{};
};

Result<std::string> line_of_input(const char* prompt, bool asked) {
    if (asked) fmt::print(stderr, "{}: ", prompt);
    std::string line;
    const bool got = static_cast<bool>(std::getline(std::cin, line));
    if (asked) fmt::print(stderr, "\n");
    if (!got) return Error{"web.password", "password", "none was given", "Type it, or send it as the first line of standard input."};
    return line;
}

/// Twice from a terminal, else the first line of standard input.
Result<std::string> read_password() {
    const bool asked = ::isatty(STDIN_FILENO) == 1;
    const QuietTerminal quiet;
    auto first = line_of_input("password", asked);
    if (!first || !asked) return first;
    const auto second = line_of_input("once more", asked);
    if (!second) return second.error();
    if (*first != *second) return Error{"web.password", "password", "the two are different", "Try again."};
    return first;
}

/// None yet is as good as an empty one, for who adds the first user.
Result<Users> load_or_none(const std::string& file) {
    struct stat state {};
    if (::stat(file.c_str(), &state) != 0 && errno == ENOENT) return Users{};
    return Users::load(file);
}

/// Asks for the password and writes the user down.
int put(Users users, User user, const std::string& file) {
    auto password = read_password();
    if (!password) return told(password.error(), exit_usage);
    auto hash = hmi::web::hash_password(*password);
    if (!hash) return told(hash.error(), exit_usage);
    user.password = std::move(*hash);
    if (auto done = users.put(std::move(user)); !done) return told(done.error(), exit_usage);
    if (auto done = users.save(file); !done) return told(done.error());
    return exit_ok;
}

Error none_of_that_name(const UserOptions& options) {
    return Error{"web.users", options.file, fmt::format("there is no user '{}'", options.name), "`taktwerk hmi user list` shows them."};
}

int add(const UserOptions& options) {
    auto users = load_or_none(options.file);
    if (!users) return told(users.error());
    if (users->find(options.name) != nullptr)
        return told({"web.users", options.file, fmt::format("'{}' is there already", options.name),
                     "`taktwerk hmi user passwd` changes the password; to change the role remove and add."},
                    exit_usage);
    return put(std::move(*users), {options.name, hmi::web::role_of(options.role).value_or(Role::viewer), {}}, options.file);
}

int change_password(const UserOptions& options) {
    auto users = Users::load(options.file);
    if (!users) return told(users.error());
    const auto* user = users->find(options.name);
    if (user == nullptr) return told(none_of_that_name(options), exit_usage);
    const User changed = *user;
    return put(std::move(*users), changed, options.file);
}

int remove(const UserOptions& options) {
    auto users = Users::load(options.file);
    if (!users) return told(users.error());
    if (!users->remove(options.name)) return told(none_of_that_name(options), exit_usage);
    if (auto done = users->save(options.file); !done) return told(done.error());
    return exit_ok;
}

int list(const UserOptions& options) {
    const auto users = Users::load(options.file);
    if (!users) return told(users.error());
    for (const auto& user : users->all()) fmt::print("{:<20} {}\n", user.name, word(user.role));
    return exit_ok;
}

}  // namespace

void add_hmi_users(CLI::App& hmi, Action& action) {
    auto* user = hmi.add_subcommand("user", "who may log in at the page");
    user->require_subcommand(1);
    const auto command = [&](const char* name, const char* what, bool named, bool with_role, int (*run)(const UserOptions&)) {
        auto options = std::make_shared<UserOptions>();
        auto* sub = user->add_subcommand(name, what);
        if (named) sub->add_option("NAME", options->name, "the user")->required();
        if (with_role)
            sub->add_option("ROLE", options->role, "viewer, operator, engineer, admin")
                ->required()
                ->check(CLI::IsMember({"viewer", "operator", "engineer", "admin"}));
        sub->add_option("--users", options->file, "the file of the users")->required();
        sub->callback([&action, options, run] { action = [options, run] { return run(*options); }; });
    };
    command("add", "a new one; the password is typed, or the first line of standard input", true, true, add);
    command("passwd", "another password; whoever is logged in with the old one is out", true, false, change_password);
    command("remove", "takes effect at once, at open pages too", true, false, remove);
    command("list", "names and roles", false, false, list);
}

}  // namespace taktwerk::apps
