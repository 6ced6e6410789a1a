// SPDX-License-Identifier: Apache-2.0
// sunstone completion bash|zsh|fish: scripts made from the very options that the program parses, so that they cannot fall behind.
// All three know where the cursor is in the same way: they walk over the words before it, follow commands, and skip the values of options.
#include <cctype>
#include <cstdio>
#include <memory>

#include "base/error.h"
#include "cli/commands.h"

namespace sunstone {

namespace {

struct Flag {
  std::vector<std::string> names;  // with their dashes
  std::string description;
  bool takes_value = false, is_file = false;
  std::vector<std::string> choices;
};

struct Command {
  std::string path;  // "" for the program itself, "cache clear" for a command of a command
  std::vector<std::pair<std::string, std::string>> commands;  // names and descriptions
  std::vector<Flag> flags;
  std::vector<std::string> choices;  // of its positional arguments
  bool takes_files = false;
};

std::string first_line(const std::string &text) { return text.substr(0, text.find('\n')); }

// The words of a type name that are meant literally: "EV|auto" has auto, "NAME:{none,filmic}" has none and filmic; capitals are place-holders.
std::vector<std::string> choices_in(const std::string &type) {
  std::vector<std::string> choices;
  std::string word;
  bool literal = true;
  for (const char c : type + "|") {
    if (c == '|' || c == ',' || c == '{' || c == '}' || c == ':' || c == ' ') {
      if (literal && !word.empty()) choices.push_back(word);
      word.clear();
      literal = true;
      continue;
    }
    word += c;
    literal = literal && (std::islower(static_cast<unsigned char>(c)) || std::isdigit(static_cast<unsigned char>(c)) || c == '-' || c == '_');
  }
  return choices;
}

bool names_file(const std::string &type) {
  for (const char *word : {"FILE", "FILM", "SCENE", "PICTURE", "PATH"})
    if (type.find(word) != std::string::npos) return true;
  return false;
}

void collect(const CLI::App &app, Command &command, std::vector<Command> &all) {
  for (const CLI::Option *option : app.get_options()) {
    if (option->get_group().empty()) continue;  // hidden
    const std::string type = option->get_type_name();
    const bool takes_value = option->get_items_expected_max() > 0;
    if (option->get_positional()) {
      for (const std::string &choice : choices_in(type)) command.choices.push_back(choice);
      command.takes_files = command.takes_files || names_file(type);
    }
    if (!option->nonpositional()) continue;
    Flag flag{{},
              first_line(option->get_description()),
              takes_value,
              takes_value && names_file(type),
              takes_value ? choices_in(type) : std::vector<std::string>{}};
    for (const std::string &name : option->get_snames()) flag.names.push_back("-" + name);
    for (const std::string &name : option->get_lnames()) flag.names.push_back("--" + name);
    command.flags.push_back(flag);
  }
  std::vector<const CLI::App *> below;
  for (const CLI::App *sub : app.get_subcommands({})) {
    if (sub->get_group().empty() || sub->get_disabled()) continue;
    if (sub->get_name().empty())
      collect(*sub, command, all);  // a group of options is part of its command
    else
      below.push_back(sub);
  }
  for (const CLI::App *sub : below) command.commands.emplace_back(sub->get_name(), first_line(sub->get_description()));
  for (const CLI::App *sub : below) {
    Command child;
    child.path = command.path.empty() ? sub->get_name() : command.path + " " + sub->get_name();
    collect(*sub, child, all);
    all.push_back(child);
  }
}

std::vector<Command> commands_of(const CLI::App &app) {
  std::vector<Command> all;
  Command root;
  collect(app, root, all);
  all.push_back(root);
  return all;
}

std::string quoted(const std::string &text, const char *quote_inside) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'')
      result += quote_inside;
    else if (static_cast<unsigned char>(c) >= 0x20)
      result += c;
  }
  return result + "'";
}
std::string shell_quoted(const std::string &text) { return quoted(text, "'\\''"); }

std::string joined(const std::vector<std::string> &words, const std::string &separator = " ") {
  std::string text;
  for (const std::string &word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

// Patterns "path:word" of a case statement, one for each that satisfies.
template <class Keep> std::string option_patterns(const std::vector<Command> &all, Keep keep) {
  std::vector<std::string> patterns;
  for (const Command &command : all)
    for (const Flag &flag : command.flags)
      if (keep(flag))
        for (const std::string &name : flag.names) patterns.push_back(shell_quoted(command.path + ":" + name));
  return patterns.empty() ? shell_quoted(":") : joined(patterns, "|");
}

// Cases of a flag that takes a value: those with choices one by one, those that name files, and those of which nothing is known.
template <class Action> std::string value_cases(const std::vector<Command> &all, Action of_choices, const std::string &of_files) {
  std::string text;
  for (const Command &command : all)
    for (const Flag &flag : command.flags)
      if (!flag.choices.empty()) {
        std::vector<std::string> patterns;
        for (const std::string &name : flag.names) patterns.push_back(shell_quoted(command.path + ":" + name));
        text += "    " + joined(patterns, "|") + ") " + of_choices(flag) + " ;;\n";
      }
  text += "    " + option_patterns(all, [](const Flag &flag) { return flag.choices.empty() && flag.is_file; }) + ") " + of_files + " ;;\n";
  return text + "    " + option_patterns(all, [](const Flag &flag) { return flag.takes_value && flag.choices.empty() && !flag.is_file; }) + ") return ;;\n";
}

// The walk over the words before the cursor, for bash and zsh. `at` is the command's path; zsh keeps `path` to itself.
std::string walk(const std::vector<Command> &all) {
  std::string text = "      case \"$at:$word\" in\n";
  for (const Command &command : all)
    for (const auto &[name, description] : command.commands)
      text += "        " + shell_quoted(command.path + ":" + name) + ") at=" + shell_quoted(command.path.empty() ? name : command.path + " " + name) +
              " ;;\n";
  text += "        " + option_patterns(all, [](const Flag &flag) { return flag.takes_value; }) + ") skip=1 ;;\n      esac\n";
  return text;
}

std::string bash_script(const std::vector<Command> &all) {
  std::string text =
      "# bash completion for sunstone:  source <(sunstone completion bash)\n"
      "_sunstone() {\n"
      "  local current=\"${COMP_WORDS[COMP_CWORD]}\" previous=\"${COMP_WORDS[COMP_CWORD-1]}\" at= word skip= i words= options= files=\n"
      "  COMPREPLY=()\n"
      "  # bash takes --option=value apart into three words\n"
      "  if [[ $current == = ]]; then current=\n"
      "  elif [[ $previous == = ]]; then previous=\"${COMP_WORDS[COMP_CWORD-2]}\"\n"
      "  fi\n"
      "  for ((i = 1; i < COMP_CWORD; i++)); do\n"
      "    word=\"${COMP_WORDS[i]}\"\n"
      "    if [[ $word == = ]]; then skip=1\n"
      "    elif [[ -n $skip ]]; then skip=\n"
      "    else\n" +
      walk(all) +
      "    fi\n"
      "  done\n"
      "  case \"$at:$previous\" in\n";
  text += value_cases(all, [](const Flag &flag) { return "words=" + shell_quoted(joined(flag.choices)) + (flag.is_file ? " files=1" : ""); }, "files=1");
  text += "    *)\n      case \"$at\" in\n";
  for (const Command &command : all) {
    std::vector<std::string> words = command.choices, options;
    for (const auto &[name, description] : command.commands) words.push_back(name);
    for (const Flag &flag : command.flags) options.insert(options.end(), flag.names.begin(), flag.names.end());
    text += "        " + shell_quoted(command.path) + ") words=" + shell_quoted(joined(words)) + " options=" + shell_quoted(joined(options)) +
            (command.takes_files ? " files=1" : "") + " ;;\n";
  }
  text +=
      "      esac\n"
      "      if [[ $current == -* ]]; then words=\"$options\" files=; fi ;;\n"
      "  esac\n"
      "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n"
      "  if [[ -n $files ]]; then\n"
      "    local found\n"
      "    mapfile -t found < <(compgen -f -- \"$current\")\n"
      "    COMPREPLY+=(\"${found[@]}\")\n"
      "    compopt -o filenames 2>/dev/null\n"
      "  fi\n"
      "  return 0\n"
      "}\n"
      "complete -F _sunstone sunstone\n";
  return text;
}

// An entry of zsh's _describe: a colon parts name and description.
std::string zsh_entry(const std::string &name, const std::string &description) {
  std::string escaped;
  for (const char c : name) escaped += c == ':' ? std::string("\\:") : std::string(1, c);
  return shell_quoted(escaped + ":" + description);
}

std::string zsh_script(const std::vector<Command> &all) {
  std::string text =
      "#compdef sunstone\n"
      "# zsh completion for sunstone: a file _sunstone in a folder of $fpath, or  source <(sunstone completion zsh)\n"
      "_sunstone() {\n"
      "  local at= word skip= i\n"
      "  local -a entries\n"
      "  for ((i = 2; i < CURRENT; i++)); do\n"
      "    word=\"${words[i]}\"\n"
      "    if [[ -n $skip ]]; then skip=\n"
      "    else\n" +
      walk(all) +
      "    fi\n"
      "  done\n"
      "  local previous=\"${words[CURRENT-1]}\"\n"
      "  if [[ $PREFIX == --*=* ]]; then previous=\"${PREFIX%%=*}\"; compset -P 1 '*='; fi\n"
      "  case \"$at:$previous\" in\n";
  text += value_cases(all, [](const Flag &flag) { return "compadd -- " + joined(flag.choices) + (flag.is_file ? "; _files" : "") + "; return"; }, "_files; return");
  text += "  esac\n  case \"$at\" in\n";
  for (const Command &command : all) {
    std::vector<std::string> options, words;
    for (const Flag &flag : command.flags)
      for (const std::string &name : flag.names) options.push_back(zsh_entry(name, flag.description));
    for (const auto &[name, description] : command.commands) words.push_back(zsh_entry(name, description));
    for (const std::string &choice : command.choices) words.push_back(zsh_entry(choice, ""));
    text += "    " + shell_quoted(command.path) + ")\n      if [[ $PREFIX == -* ]]; then entries=(" + joined(options) +
            "); _describe option entries; return; fi\n";
    if (!words.empty()) text += "      entries=(" + joined(words) + "); _describe command entries\n";
    if (command.takes_files) text += "      _files\n";
    text += "      ;;\n";
  }
  text +=
      "  esac\n"
      "}\n"
      "if [[ \"${funcstack[1]}\" == _sunstone ]]; then _sunstone \"$@\"; else compdef _sunstone sunstone; fi\n";
  return text;
}

std::string fish_quoted(const std::string &text) {
  std::string escaped;
  for (const char c : text) escaped += c == '\\' ? std::string("\\\\") : std::string(1, c);
  return quoted(escaped, "\\'");
}

std::string fish_script(const std::vector<Command> &all) {
  std::string text =
      "# fish completion for sunstone:  sunstone completion fish | source\n"
      "function __sunstone_at\n"
      "  set -l at ''\n"
      "  set -l skip ''\n"
      "  set -l words (commandline -opc)\n"
      "  for word in $words[2..-1]\n"
      "    if test -n \"$skip\"\n"
      "      set skip ''\n"
      "      continue\n"
      "    end\n"
      "    switch \"$at:$word\"\n";
  for (const Command &command : all) {
    for (const auto &[name, description] : command.commands)
      text += "      case " + fish_quoted(command.path + ":" + name) + "\n        set at " +
              fish_quoted(command.path.empty() ? name : command.path + " " + name) + "\n";
    for (const Flag &flag : command.flags)
      if (flag.takes_value)
        for (const std::string &name : flag.names) text += "      case " + fish_quoted(command.path + ":" + name) + "\n        set skip 1\n";
  }
  text +=
      "    end\n"
      "  end\n"
      "  test \"$at\" = \"$argv[1]\"\n"
      "end\n"
      "complete -c sunstone -e\n"
      "complete -c sunstone -f\n";
  for (const Command &command : all) {
    const std::string here = "complete -c sunstone -n " + fish_quoted("__sunstone_at " + fish_quoted(command.path));
    if (command.takes_files) text += here + " -F\n";
    for (const auto &[name, description] : command.commands) text += here + " -a " + fish_quoted(name) + " -d " + fish_quoted(description) + "\n";
    if (!command.choices.empty()) text += here + " -a " + fish_quoted(joined(command.choices)) + "\n";
    for (const Flag &flag : command.flags) {
      text += here;
      for (const std::string &name : flag.names)
        text += name.starts_with("--") ? " -l " + fish_quoted(name.substr(2)) : " -s " + fish_quoted(name.substr(1));
      if (flag.takes_value) text += flag.is_file ? " -r -F" : " -x";
      if (!flag.choices.empty()) text += " -a " + fish_quoted(joined(flag.choices));
      text += " -d " + fish_quoted(flag.description) + "\n";
    }
  }
  return text;
}

}  // namespace

std::string completion_script(const CLI::App &app, const std::string &shell) {
  const std::vector<Command> all = commands_of(app);
  if (shell == "bash") return bash_script(all);
  if (shell == "zsh") return zsh_script(all);
  if (shell == "fish") return fish_script(all);
  throw UsageError("completion", "the shell " + printable(shell) + " is not known", "bash, zsh and fish are");
}

void add_completion(CLI::App &app, CommandContext &) {
  auto shell = std::make_shared<std::string>();
  CLI::App *command = app.add_subcommand("completion", "Print a completion script for a shell");
  command->add_option("shell", *shell, "The shell")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}))->type_name("NAME");
  command->footer(
      "Examples:\n"
      "  source <(sunstone completion bash)                               now; put it into ~/.bashrc to have it always\n"
      "  sunstone completion zsh > ~/.zfunc/_sunstone                     with fpath+=~/.zfunc before compinit in ~/.zshrc\n"
      "  sunstone completion fish > ~/.config/fish/completions/sunstone.fish");
  command->callback([shell, &app] { std::fputs(completion_script(app, *shell).c_str(), stdout); });
}

}  // namespace sunstone
