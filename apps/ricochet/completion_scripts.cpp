#include <fmt/format.h>

#include "completion.hpp"
#include "ricochet/base/error.hpp"

namespace ricochet::program {

namespace {

// bash also splits words at "=" and ":". For the program, text without blanks is a single word, and of each of its
// answers bash needs only the part after the last of these characters.
constexpr const char* bash_script = R"~sh~(# Completion of ricochet for bash: the program itself lists the candidates.
_ricochet() {
  local words=() word line=$COMP_LINE i typed candidate IFS=$'\n'
  for ((i = 0; i <= COMP_CWORD; i++)); do
    word=${COMP_WORDS[i]}
    if ((i > 1)) && [[ -n $line && $line == "${line#[[:space:]]}" ]]; then words[${#words[@]} - 1]+=$word; else words+=("$word"); fi
    line=${line#"${line%%[![:space:]]*}"}
    line=${line#"$word"}
  done
  typed=${words[${#words[@]} - 1]}
  local typed_words=("${words[@]:1}")
  COMPREPLY=()
  for candidate in $("${words[0]/#\~\//$HOME/}" complete -- "${typed_words[@]//\\/}" 2>/dev/null); do
    candidate=${candidate%%$'\t'*}
    [[ $candidate == *[/=.] ]] && compopt -o nospace 2>/dev/null
    [[ $candidate == *[!A-Za-z0-9_./=,:@%+-]* ]] && printf -v candidate %q "$candidate"
    COMPREPLY+=("${candidate#"${typed%"${typed##*[=:]}"}"}")
  done
}
complete -F _ricochet ricochet
)~sh~";

constexpr const char* zsh_script = R"~sh~(#compdef ricochet
# Completion of ricochet for zsh: the program itself lists the candidates.
_ricochet() {
  local line word
  local -a whole whole_docs open open_docs
  for line in "${(@f)$("${words[1]/#\~\//$HOME/}" complete -- "${(@Q)words[2,CURRENT]}" 2>/dev/null)}"; do
    word=${line%%$'\t'*}
    [[ -z $word ]] && continue
    if [[ $word == *[/=.] ]]; then
      open+=("$word"); open_docs+=("${line/$'\t'/  -- }")
    else
      whole+=("$word"); whole_docs+=("${line/$'\t'/  -- }")
    fi
  done
  (( $#whole )) && compadd -l -d whole_docs -a whole
  (( $#open )) && compadd -l -S '' -d open_docs -a open
}
if [[ $funcstack[1] == _ricochet ]]; then _ricochet "$@"; else compdef _ricochet ricochet; fi
)~sh~";

constexpr const char* fish_script = R"~sh~(# Completion of ricochet for fish: the program itself lists the candidates.
function __ricochet_complete
    set -l words (commandline -opc) (commandline -ct)
    $words[1] complete -- $words[2..-1] 2>/dev/null
end
complete -c ricochet -f -a '(__ricochet_complete)'
)~sh~";

}  // namespace

std::string completion_script(const std::string& shell) {
  if (shell == "bash") return bash_script;
  if (shell == "zsh") return zsh_script;
  if (shell == "fish") return fish_script;
  throw Error(ErrorKind::usage,
              fmt::format("completion: there is no script for \"{}\"; available: bash, zsh and fish", shell));
}

}  // namespace ricochet::program
