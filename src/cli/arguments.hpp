/// Turning the words of the command line into values.
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "zbuffer/scorer.hpp"

namespace rejoin::cli {

/// The words that an option accepts, with what they mean.
template <typename Value>
using Choices = std::vector<std::pair<std::string, Value>>;

/// Adds an option that takes one of a few words; help shows them as "one|two|three: description".
template <typename Value>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Value& value, const Choices<Value>& choices,
                        const std::string& description) {
  std::string words;
  for (const auto& [word, meaning] : choices) words += (words.empty() ? "" : "|") + word;
  const auto parse = [&value, choices, words, name](const std::string& text) {
    for (const auto& [word, meaning] : choices) {
      if (word != text) continue;
      value = meaning;
      return;
    }
    throw CLI::ValidationError(name, "'" + text + "' is none of " + words);
  };
  return app.add_option_function<std::string>(name, parse, words + ": " + description)->type_name("WORD");
}

/// The backends that a user may choose.
Choices<zbuffer::Backend> backend_choices();

/// Lets only numbers from low to high through; NaN is outside.
CLI::Validator in_range(double low, double high);

/// The same for whole numbers.
CLI::Validator whole_in_range(double low, double high);

/// What numbers an option takes, and the word for them in its help.
struct NumberRange {
  double low;
  double high;
  const char* word = "N";
};

/// Adds an option that takes a number of a range; NaN is outside.
template <typename Number>
CLI::Option* add_number(CLI::App& app, const std::string& name, Number& value, const NumberRange& range,
                        const std::string& description) {
  return app.add_option(name, value, description)
      ->type_name(range.word)
      ->check(std::is_integral_v<Number> ? whole_in_range(range.low, range.high)
                                         : in_range(range.low, range.high));
}

/// Whole numbers with commas between them.
/// \throws CLI::ValidationError one is none, is missing, or is outside the range
std::vector<double> whole_numbers(const std::string& option, const std::string& text,
                                  const NumberRange& range);

/// Adds an option that takes whole numbers with commas between them, and may be repeated.
template <typename Number>
CLI::Option* add_numbers(CLI::App& app, const std::string& name, std::vector<Number>& values,
                         const NumberRange& range, const std::string& description) {
  const auto parse = [&values, name, range](const std::vector<std::string>& texts) {
    values.clear();
    for (const std::string& text : texts) {
      for (const double number : whole_numbers(name, text, range))
        values.push_back(static_cast<Number>(number));
    }
  };
  return app.add_option_function<std::vector<std::string>>(name, parse, description)
      ->type_name(range.word)
      ->expected(1)
      ->take_all();
}

/// Adds --seed, a whole number that a run's database can hold: 0 .. 2^63 - 1.
/// \param description  without the range
CLI::Option* add_seed(CLI::App& app, std::uint64_t& seed, const std::string& description);

/// A direction "x,y,z", scaled to unit length.
/// \throws UsageError not three finite numbers, or length 0
glm::dvec3 parse_direction(const std::string& option, const std::string& text);

/// Unit directions of an option that may be given several times.
std::vector<glm::dvec3> parse_directions(const std::string& option, const std::vector<std::string>& texts);

/// \throws UsageError both paths lead to the same file, or to files of the same bytes
void require_two_files(const std::string& a, const std::string& b);

}  // namespace rejoin::cli
