function export_iddata(data, file)
%EXPORT_IDDATA  Writes an iddata object to a .mat file, or an idfrd object to a .csv file, as acquisition blocks of bodeflow read them.
if isa(data, 'idfrd')
  f = data.Frequency(:); if ~strcmpi(data.FrequencyUnit, 'Hz'), f = f / (2 * pi); end   % rad/s, the unit of idfrd
  [outputs, inputs, ~] = size(data.ResponseData); header = 'f [Hz]'; table = f;
  for i = 1:outputs, for j = 1:inputs
    g = squeeze(data.ResponseData(i, j, :)); header = sprintf('%s,re(G%d%d),im(G%d%d)', header, i, j, i, j); table = [table real(g) imag(g)]; %#ok<AGROW>
  end, end
  id = fopen(file, 'w'); fprintf(id, '%s\n', header); fprintf(id, [repmat('%.17g,', 1, size(table, 2) - 1) '%.17g\n'], table.'); fclose(id);
else
  u = data.InputData; y = data.OutputData; Ts = data.Ts; names = char([data.InputName; data.OutputName]); %#ok<NASGU>
  save(file, 'u', 'y', 'Ts', 'names', '-v7');
end
end
