// Verbs and options as verbs see them. CLI11 stands behind: only the shell includes it, for its headers cost seconds.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace sightline::cli {

/// Numbers that an option takes: from `least` to `most`. The type of the limits is the type that is read.
template <class T>
struct Range {
    T least, most;
};
template <class T>
Range(T, T) -> Range<T>;

/// Words that an option takes.
using OneOf = std::vector<std::string>;

/// Says what is wrong with a text; nothing if it is right.
struct Validator {
    std::function<std::string(const std::string&)> fault;
    std::string name;
};

/// An option of a command. A handle: it is copied, and `->` reaches its own members.
class Option {
public:
    Option(CLI::Option* option) : option_(option) {}
    explicit operator bool() const { return option_ != nullptr; }
    Option* operator->() { return this; }
    const Option* operator->() const { return this; }

    template <class T>
    Option& check(Range<T> range);
    Option& check(const OneOf& words);
    Option& check(const Validator& validator);
    Option& type_name(const std::string& name);
    Option& group(const std::string& name);
    Option& description(const std::string& text);
    Option& capture_default_str();
    Option& default_str(const std::string& text);
    Option& required(bool needed = true);
    Option& expected(int count);
    Option& expected(int least, int most);
    Option& delimiter(char between);
    Option& allow_extra_args(bool allowed = true);
    /// Keeps the values of each time that it is given.
    Option& take_all();
    Option& excludes(Option other);
    Option& needs(Option other);

    size_t count() const;
    bool nonpositional() const;
    std::string get_name() const;
    std::string get_group() const;
    std::string get_type_name() const;
    std::vector<std::string> results() const;

    CLI::Option* cli() const { return option_; }

private:
    CLI::Option* option_;
};

/// The tool or one of its verbs. A handle, as Option is.
class Command {
public:
    Command(CLI::App* app) : app_(app) {}
    Command* operator->() { return this; }
    const Command* operator->() const { return this; }
    Command& operator*() { return *this; }
    const Command& operator*() const { return *this; }

    Command add_subcommand(const std::string& name, const std::string& about);
    /// T: int, uint32_t, uint64_t, float, double, optional ones of uint32_t and double, std::string, or a vector of doubles or texts.
    template <class T>
    Option add_option(const std::string& name, T& value, const std::string& help);
    template <class T>
    Option add_option_function(const std::string& name, std::function<void(const T&)> take, const std::string& help);
    Option add_flag(const std::string& name, bool& value, const std::string& help);
    Option add_flag_callback(const std::string& name, std::function<void()> take, const std::string& help);
    void callback(std::function<void()> run);
    void remove_option(Option option);

    /// How often an option is given.
    size_t count(const std::string& option) const;
    Option get_option(const std::string& name) const;
    /// Null if there is none.
    Option get_option_no_throw(const std::string& name) const;
    std::vector<Option> get_options() const;
    bool is_help(Option option) const;

    CLI::App& cli() const { return *app_; }

private:
    CLI::App* app_;
};

/// The whole text as a number, as options read it.
bool readNumber(const std::string& text, double& number);
std::vector<std::string> splitAt(const std::string& text, char between);

/// Ends the reading of an option that `take` of add_option_function() was given.
[[noreturn]] void refuse(const std::string& option, const std::string& what);

}  // namespace sightline::cli
