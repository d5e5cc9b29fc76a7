// Verbs and options, by CLI11.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/options.h"

#include <optional>
#include <utility>

#include <CLI/CLI.hpp>

namespace sightline::cli {

template <class T>
Option& Option::check(Range<T> range) {
    option_->check(CLI::Range(range.least, range.most));
    return *this;
}
template Option& Option::check(Range<int>);
template Option& Option::check(Range<uint32_t>);
template Option& Option::check(Range<uint64_t>);
template Option& Option::check(Range<double>);

Option& Option::check(const OneOf& words) {
    option_->check(CLI::IsMember(words));
    return *this;
}
Option& Option::check(const Validator& validator) {
    option_->check(CLI::Validator(validator.fault, "", validator.name));
    return *this;
}
Option& Option::type_name(const std::string& name) {
    option_->type_name(name);
    return *this;
}
Option& Option::group(const std::string& name) {
    option_->group(name);
    return *this;
}
Option& Option::description(const std::string& text) {
    option_->description(text);
    return *this;
}
Option& Option::capture_default_str() {
    option_->capture_default_str();
    return *this;
}
Option& Option::default_str(const std::string& text) {
    option_->default_str(text);
    return *this;
}
Option& Option::required(bool needed) {
    option_->required(needed);
    return *this;
}
Option& Option::expected(int count) {
    option_->expected(count);
    return *this;
}
Option& Option::expected(int least, int most) {
    option_->expected(least, most);
    return *this;
}
Option& Option::delimiter(char between) {
    option_->delimiter(between);
    return *this;
}
Option& Option::allow_extra_args(bool allowed) {
    option_->allow_extra_args(allowed);
    return *this;
}
Option& Option::take_all() {
    option_->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    return *this;
}
Option& Option::excludes(Option other) {
    option_->excludes(other.option_);
    return *this;
}
Option& Option::needs(Option other) {
    option_->needs(other.option_);
    return *this;
}

size_t Option::count() const { return option_->count(); }
bool Option::nonpositional() const { return option_->nonpositional(); }
std::string Option::get_name() const { return option_->get_name(); }
std::string Option::get_group() const { return option_->get_group(); }
std::string Option::get_type_name() const { return option_->get_type_name(); }
std::vector<std::string> Option::results() const { return std::as_const(*option_).results(); }

Command Command::add_subcommand(const std::string& name, const std::string& about) {
    return app_->add_subcommand(name, about);
}

template <class T>
Option Command::add_option(const std::string& name, T& value, const std::string& help) {
    return app_->add_option(name, value, help);
}
template Option Command::add_option(const std::string&, int&, const std::string&);
template Option Command::add_option(const std::string&, uint32_t&, const std::string&);
template Option Command::add_option(const std::string&, uint64_t&, const std::string&);
template Option Command::add_option(const std::string&, float&, const std::string&);
template Option Command::add_option(const std::string&, double&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<double>&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<uint32_t>&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<uint64_t>&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<double>&, const std::string&);
template Option Command::add_option(const std::string&, std::string&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<std::string>&, const std::string&);

template <class T>
Option Command::add_option_function(const std::string& name, std::function<void(const T&)> take,
                                    const std::string& help) {
    return app_->add_option_function<T>(name, std::move(take), help);
}
template Option Command::add_option_function(const std::string&, std::function<void(const double&)>,
                                             const std::string&);
template Option Command::add_option_function(const std::string&, std::function<void(const std::string&)>,
                                             const std::string&);
template Option Command::add_option_function(const std::string&, std::function<void(const std::vector<std::string>&)>,
                                             const std::string&);

Option Command::add_flag(const std::string& name, bool& value, const std::string& help) {
    return app_->add_flag(name, value, help);
}
Option Command::add_flag_callback(const std::string& name, std::function<void()> take, const std::string& help) {
    return app_->add_flag_callback(name, std::move(take), help);
}
void Command::callback(std::function<void()> run) { app_->callback(std::move(run)); }
void Command::remove_option(Option option) { app_->remove_option(option.cli()); }

size_t Command::count(const std::string& option) const { return app_->count(option); }
Option Command::get_option(const std::string& name) const { return app_->get_option(name); }
Option Command::get_option_no_throw(const std::string& name) const { return app_->get_option_no_throw(name); }
std::vector<Option> Command::get_options() const {
    const std::vector<CLI::Option*> options = app_->get_options({});
    return {options.begin(), options.end()};
}
bool Command::is_help(Option option) const { return app_->get_help_ptr() == option.cli(); }

bool readNumber(const std::string& text, double& number) { return CLI::detail::lexical_cast(text, number); }
std::vector<std::string> splitAt(const std::string& text, char between) { return CLI::detail::split(text, between); }
void refuse(const std::string& option, const std::string& what) { throw CLI::ValidationError(option, what); }

}  // namespace sightline::cli
