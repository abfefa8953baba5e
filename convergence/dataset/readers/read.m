% Tests a law against torsion.csv: Tresca's twist of the stick ratio c is arcosh(1/c)/(2 pi). MATLAB or Octave.
file = fopen('../tables/torsion.csv');
tested = 0; largest = 0; line = fgetl(file);
while ischar(line)
  row = strsplit(line, ',', 'CollapseDelimiters', false);  % case, given, at, radius, quantity, value, error, ...
  if strcmp(row{1}, 'constant')
    value = str2double(row{6});
    switch row{5}
      case 'stick_ratio'
        stick = value;
      case 'stick_complement'
        lacks = value;
      case 'twist'  % of a load it follows both
        yours = asinh(sqrt(lacks * (1 + stick)) / stick) / (2 * pi);
        largest = max(largest, abs(yours / value - 1));
        tested = tested + 1;
    end
  end
  line = fgetl(file);
end
fprintf('%d twists, largest relative error %.1e, allowed 1e-12\n', tested, largest);
if ~(tested > 0 && largest <= 1e-12)
  exit(1);
end
