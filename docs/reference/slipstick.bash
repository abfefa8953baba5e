# bash completion of slipstick, written by `make reference` from the program's own options.
# In zsh: autoload -U +X bashcompinit && bashcompinit, then source this file.
_slipstick() {
  local current="${COMP_WORDS[COMP_CWORD]}" previous="${COMP_WORDS[COMP_CWORD - 1]}"
  local words=""
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    words="exact solve check law study gate hard run digits report bench compare --help --version"
  else
    case "${COMP_WORDS[1]} $previous" in
      "exact --moment-ratio" | "exact --moment-deficit" | "exact --stick-ratio" | "exact --stick-complement" | "exact --twist" | "exact --history" | "exact --points" | "exact --unload-to" | "exact --at" | "exact --poisson" | "exact --yield-stress" | "exact --certified" | "exact --radius" | "exact --profile" | "exact --normal-load" | "exact --effective-modulus" | "exact --shape" | "exact --friction" | "exact --shear-modulus" | "exact --json") return ;;
      "exact "*) [[ $current != -* ]] || words="--moment-ratio --moment-deficit --stick-ratio --stick-complement --twist --history --help --points --unload-to --at --poisson --yield-stress --certified --radius --profile --normal-load --effective-modulus --shape --friction --shear-modulus --json --quiet" ;;
      "solve --set") words="$_slipstick_keys"; compopt -o nospace 2>/dev/null ;;
      "solve --accuracy-of") words="twist traction stick_radius" ;;
      "solve --program" | "solve --model" | "solve --accuracy" | "solve --uncertain" | "solve --proven" | "solve --ranks" | "solve --fields" | "solve --checkpoint" | "solve --figure" | "solve --loop" | "solve --depths" | "solve --stresses" | "solve --stress-figure" | "solve --dang-van" | "solve --findley" | "solve --memory-limit" | "solve --json") return ;;
      "solve "*) [[ $current != -* ]] || words="--help --set --program --allow-programs --model --accuracy --accuracy-of --uncertain --plan --continuum --proven --ranks --fields --checkpoint --resume --figure --loop --depths --stresses --stress-figure --dang-van --findley --memory-limit --json --quiet" ;;
      "check --set") words="$_slipstick_keys"; compopt -o nospace 2>/dev/null ;;
      "check --columns" | "check --twist" | "check --tolerance" | "check --junit" | "check --summary" | "check --stick-slope" | "check --normal-stiffness" | "check --held-at" | "check --read-as" | "check --json") return ;;
      "check "*) [[ $current != -* ]] || words="--help --set --columns --twist --discrete --tolerance --pressure-given --strict --junit --summary --stick-slope --normal-stiffness --held-at --read-as --json --quiet" ;;
      "law --set") words="$_slipstick_keys"; compopt -o nospace 2>/dev/null ;;
      "law --profile" | "law --write" | "law --prefix" | "law --error" | "law --table-error" | "law --element-error" | "law --elements" | "law --limit-loads" | "law --json") return ;;
      "law "*) [[ $current != -* ]] || words="--help --set --profile --write --prefix --error --table-error --element-error --elements --limit-loads --json --quiet" ;;
      "study --set") words="$_slipstick_keys"; compopt -o nospace 2>/dev/null ;;
      "study --figure" | "study --output" | "study --jobs" | "study --memory-limit" | "study --program" | "study --list-runs" | "study --json") return ;;
      "study "*) [[ $current != -* ]] || words="--help --set --figure --output --jobs --memory-limit --program --allow-programs --list-runs --json --quiet" ;;
      "gate --only" | "gate --junit" | "gate --summary" | "gate --history" | "gate --figure" | "gate --badge" | "gate --bencher" | "gate --benchmark-action" | "gate --times" | "gate --results" | "gate --output" | "gate --jobs" | "gate --memory-limit" | "gate --program" | "gate --list-runs" | "gate --json") return ;;
      "gate "*) [[ $current != -* ]] || words="--help --only --list --junit --summary --history --figure --badge --bencher --benchmark-action --times --results --output --jobs --memory-limit --program --allow-programs --list-runs --json --quiet" ;;
      "hard --set") words="$_slipstick_keys"; compopt -o nospace 2>/dev/null ;;
      "hard --fields" | "hard --beside" | "hard --output" | "hard --jobs" | "hard --memory-limit" | "hard --program" | "hard --list-runs" | "hard --json") return ;;
      "hard "*) [[ $current != -* ]] || words="--help --set --fields --once --beside --output --jobs --memory-limit --program --allow-programs --list-runs --json --quiet" ;;
      "run --only" | "run --output" | "run --jobs" | "run --memory-limit" | "run --program" | "run --json") return ;;
      "run "*) [[ $current != -* ]] || words="--help --only --output --jobs --memory-limit --program --allow-programs --json --quiet" ;;
      "digits --set") words="$_slipstick_keys"; compopt -o nospace 2>/dev/null ;;
      "digits --samples" | "digits --seed" | "digits --output" | "digits --jobs" | "digits --memory-limit" | "digits --json") return ;;
      "digits "*) [[ $current != -* ]] || words="--help --set --samples --seed --output --jobs --memory-limit --json --quiet" ;;
      "report --output" | "report --benchmarks" | "report --want" | "report --uncertain" | "report --junit" | "report --summary" | "report --memory-limit" | "report --program" | "report --beside" | "report --json") return ;;
      "report "*) [[ $current != -* ]] || words="--help --output --quick --full --benchmarks --want --uncertain --junit --summary --memory-limit --program --allow-programs --beside --json --quiet" ;;
      "bench --set") words="$_slipstick_keys"; compopt -o nospace 2>/dev/null ;;
      "bench --beside" | "bench --program" | "bench --output" | "bench --filter" | "bench --accuracy-data" | "bench --against" | "bench --pair" | "bench --rounds" | "bench --effect" | "bench --json") return ;;
      "bench "*) [[ $current != -* ]] || words="--help --set --beside --program --output --filter --quick --accuracy-data --against --pair --rounds --effect --json --quiet" ;;
      "compare --effect" | "compare --level" | "compare --summary" | "compare --junit" | "compare --json") return ;;
      "compare "*) [[ $current != -* ]] || words="--help --effect --level --same-machine --debug-library --summary --junit --json --quiet" ;;
    esac
  fi
  [ -z "$words" ] || COMPREPLY=($(compgen -W "$words" -- "$current"))
}
_slipstick_keys="name= cycles= units= upper.shape= upper.radius= upper.radius_1= upper.radius_2= upper.slope= upper.flat_radius= upper.corner_radius= upper.exponent= upper.coefficient= upper.inner_radius= upper.at= upper.angle= upper.file= upper.spacing= upper.unit= upper.seed= upper.hurst= upper.rms_slope= upper.longest= upper.shortest= upper.period= upper.combine= upper.ends_at_grid_edge= upper.rigid= upper.young_modulus= upper.poisson_ratio= upper.yield_stress= upper.layer.thickness= upper.layer.young_modulus= upper.layer.poisson_ratio= lower.shape= lower.radius= lower.radius_1= lower.radius_2= lower.slope= lower.flat_radius= lower.corner_radius= lower.exponent= lower.coefficient= lower.inner_radius= lower.at= lower.angle= lower.file= lower.spacing= lower.unit= lower.seed= lower.hurst= lower.rms_slope= lower.longest= lower.shortest= lower.period= lower.shape.shape= lower.shape.radius= lower.shape.radius_1= lower.shape.radius_2= lower.shape.slope= lower.shape.flat_radius= lower.shape.corner_radius= lower.shape.exponent= lower.shape.coefficient= lower.shape.inner_radius= lower.shape.at= lower.shape.angle= lower.shape.file= lower.shape.spacing= lower.shape.unit= lower.shape.seed= lower.shape.hurst= lower.shape.rms_slope= lower.shape.longest= lower.shape.shortest= lower.shape.period= lower.rigid= lower.young_modulus= lower.poisson_ratio= lower.yield_stress= lower.layer.thickness= lower.layer.young_modulus= lower.layer.poisson_ratio= layer.kind= layer.normal_compliance= layer.tangential_compliance= contact.friction= contact.friction_law= contact.shear_strength= contact.friction_exponent= contact.friction_map= contact.pressure= contact.pressure_file= contact.coupling= load.normal= load.moment_ratio= load.moment= load.twist= load.force= load.displacement= grid.cells= grid.extent= solver.method= solver.program= solver.operator= solver.tolerance= solver.max_iterations= solver.model= solver.cell_traction= solver.substeps= solver.threads= solver.rounding_seed="
# If no word matches, bash completes files.
complete -o default -F _slipstick slipstick
