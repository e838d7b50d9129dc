% Fits of frequency responses with Octave's packages: reads a command a line on standard input,
%   METHOD ORDER TUNING FILE
% METHOD: invfreqs, invfreqz or fitfrd; TUNING: number of a choice of scale, from 1 on; FILE: rows of rad/s, real and imaginary part.
% Answers "CPU RMS UNSTABLE TUNINGS": seconds of CPU of one call, rms of the error over the lines, unstable poles (-1: it failed), how
% many tunings there are. A first line names the BLAS.
1;

function [response, unstable, cpu] = levi_in_s(H, w, order, scale)
  start = cputime();
  [b, a] = invfreqs(H, w / scale, order, order);
  cpu = cputime() - start;
  x = 1i * w / scale;
  response = polyval(b, x) ./ polyval(a, x);
  unstable = sum(real(roots(a)) > 0);
end

function [response, unstable, cpu] = levi_in_z(H, w, order, prewarp)
  theta = 2 * atan(w / prewarp);
  start = cputime();
  [b, a] = invfreqz(H, theta, order, order);
  cpu = cputime() - start;
  x = exp(-1i * theta);
  response = polyval(fliplr(b), x) ./ polyval(fliplr(a), x);
  unstable = sum(abs(roots(a)) > 1);
end

% prewarp 0: in continuous time, which SB10YD maps to the circle by a rule of its own; else the map is done here.
function [response, unstable, cpu] = slicot(H, w, order, prewarp)
  if prewarp > 0
    theta = 2 * atan(w / prewarp);
    start = cputime();
    system = fitfrd(frd(H, theta, 1), order, 0);
    cpu = cputime() - start;
    [a, b, c, d] = ssdata(system);
    x = exp(1i * theta);
    unstable = sum(abs(eig(a)) > 1);
  else
    start = cputime();
    system = fitfrd(frd(H, w), order, 0);
    cpu = cputime() - start;
    [a, b, c, d] = ssdata(system);
    x = 1i * w;
    unstable = sum(real(eig(a)) > 0);
  end
  response = zeros(size(H));
  for k = 1:numel(w)
    response(k) = c * ((x(k) * eye(rows(a)) - a) \ b) + d;
  end
end

function [cpu, rms, unstable] = measured(method, order, choice, H, w)
  [response, unstable, cpu] = method(H, w, order, choice);
  rms = sqrt(mean(abs(response - H) .^ 2));
end

warning('off', 'all');
pkg('load', 'control');
pkg('load', 'signal');
printf('%s, BLAS: %s\n', OCTAVE_VERSION, strtok(version('-blas'), '('));
fflush(stdout);
while true
  try
    line = input('', 's');  % fgetl(stdin) waits for a full buffer
  catch
    break;
  end
  words = strsplit(line, ' ');
  data = dlmread(words{4});
  w = data(:, 1);
  H = data(:, 2) + 1i * data(:, 3);
  middle = sqrt(w(1) * w(end));
  scans = middle * 10 .^ (0:1/6:1);
  switch words{1}
    case 'invfreqs', method = @levi_in_s; choices = [middle, median(w), w(end)];
    case 'invfreqz', method = @levi_in_z; choices = scans;
    case 'fitfrd', method = @slicot; choices = [0, scans];
  end
  try
    [cpu, rms, unstable] = measured(method, str2double(words{2}), choices(str2double(words{3})), H, w);
  catch
    cpu = 0; rms = Inf; unstable = -1;
  end
  printf('%.9g %.9g %d %d\n', cpu, rms, unstable, numel(choices));
  fflush(stdout);
end
