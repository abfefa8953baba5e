# Tests a law against torsion.csv: Tresca's twist of the stick ratio c is arcosh(1/c)/(2 pi).
function largest_error(file)
    stick = lacks = largest = 0.0
    tested = 0
    for line in eachline(file)
        row = split(line, ',')  # case, given, at, radius, quantity, value, error, ...
        row[1] == "constant" || continue
        value = parse(Float64, row[6])
        if row[5] == "stick_ratio"
            stick = value
        elseif row[5] == "stick_complement"
            lacks = value
        elseif row[5] == "twist"  # of a load it follows both
            yours = asinh(sqrt(lacks * (1 + stick)) / stick) / 2pi
            largest = max(largest, abs(yours / value - 1))
            tested += 1
        end
    end
    return tested, largest
end

tested, largest = largest_error("../tables/torsion.csv")
println("$tested twists, largest relative error $largest, allowed 1e-12")
exit(tested > 0 && largest <= 1e-12 ? 0 : 1)
